//! Integration tests of `corniche-pipeline`, in one binary. The first line of each module says what
//! is tested.

mod around_the_globe;
mod bounds;
mod crossings;
mod faults;
mod inputs;
mod plan;
mod plan_remote;
mod polygon;
mod promises;
mod railways;
mod reader_of_before;
mod recorded_terrain;
mod rectangles;
mod roads_beside_data;
mod seams;
mod several_extracts;
mod skirts;
mod support;
mod true_lengths;
mod verify_datums;
mod verify_fields;
mod verify_header;
mod verify_layers;
mod verify_payload;
mod verify_photos;
mod verify_roads;
mod verify_sees;
mod verify_spans;
mod voids;
mod whole_spans;
