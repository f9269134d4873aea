//! The integration tests of `corniche-osm`, in one binary. The first line of each module says what
//! it tests.

mod areas;
mod areas_against_osmium;
mod boundaries;
mod boundaries_against_osmium;
mod common;
mod fixtures;
mod formats;
mod history;
mod hostile;
mod losses;
mod one_reading;
mod points;
mod points_against_osmium;
mod railways;
mod real_data;
mod seeds;
mod several;
mod shares;
mod within_memory;
