// Decks of bridges: slabs in space, with the road on top. Both methods draw them alike.
//
//            ______________________________
//          ╱     road                    ╱│     A piece of a deck is all that lies in plan at most half its width from
//         ╱______________________________╱ │    its segment, and at most the slab's thickness under the road. It ends
//        │  side                        │ ╱     with a half disc, as roads do, or at a mitre where the next piece begins.
//        │______________________________│╱      A box around it only selects pixels. For each of them the ray from the
//            underside                          eye is followed to where it enters the piece.
//
// Drawn widths are larger than true widths, so the ground next to a deck may be higher than the
// deck: on a hillside, and where bridges begin. Such ground would bury a part of the road or
// flicker through it. So ground that is within the piece in plan, and higher than its underside, is
// painted like the road.
//
// The same boxes are drawn three times: first to find the depth of the nearest deck at each pixel,
// then for the labels of roads, then for the labels of sides and undersides. Of equally high decks
// the largest label stays, as on the ground; otherwise the label of the nearest deck stays. Labels
// of sides are the smallest, so the step between two decks that overlap and are almost equally high
// is not a line.

struct DeckIn {
    @builtin(vertex_index) corner: u32,
    // Plan position and true height above the reference point.
    @location(0) start_in_tile: vec3f,
    @location(1) end_in_tile: vec3f,
    // Mitres at the start and at the end: the piece is cut off perpendicular to these unit vectors;
    // 0 for a round cap.
    @location(2) mitres: vec4f,
    // x: thickness of the slab, true metres; y: world metres across the road per true metre.
    @location(3) slab_width_factor: vec2f,
    // Lowest four bits: class; three bits: look; one bit each if the deck comes down to the ground
    // at its start and at its end; one bit for a ribbon.
    @location(4) class_and_look: u32,
    // The road's own width, as `road_with` takes it.
    @location(5) own_width: f32,
    // Same as in RoadFragment.
    @location(6) dash: vec2f,
    // x: same as part_m in RoadFragment; y: length of the deck, world metres.
    @location(7) lengths: vec2f,
}

struct DeckFragment {
    @builtin(position) clip: vec4f,
    // Relative to the eye.
    @location(0) @interpolate(flat) start: vec3f,
    @location(1) @interpolate(flat) start_to_end: vec3f,
    @location(2) @interpolate(flat) mitres: vec4f,
    // xy: half the width at the start and at the end; z: thickness of the slab. World metres.
    @location(3) @interpolate(flat) size: vec3f,
    @location(4) @interpolate(flat) class_and_look: u32,
    // Same as in RoadFragment.
    @location(5) @interpolate(flat) half_width_m: f32,
    @location(6) @interpolate(flat) dash: vec2f,
    @location(7) @interpolate(flat) part_m: f32,
    // Whether the deck is so short that the more important road is drawn on top, as on the ground.
    @location(8) @interpolate(flat) is_short: u32,
}

// Thickness of a ribbon, world metres. A ribbon is a road that is not draped on the ground. Ground
// hides it, except for a tolerance that keeps a ribbon exactly on the ground visible.
const RIBBON_M = 0.05;
const OVER_RIBBON_M = 0.25;

fn is_ribbon(class_and_look: u32) -> bool {
    return (class_and_look & 512u) != 0u;
}

// How far a deck is extended, relative to how much too wide class 0 is drawn, because carriageways
// are next to each other.
const WIDEST_BENEATH = 1.5;
// Half the width of a carriageway, true metres.
const TRUE_HALF_WIDTH_M = 6.0;
// Minimum length of a deck in half widths of class 0: a quarter more than such a road is wide.
const SHORTEST_DECK = 2.5;

// The offset on the picture of a point next to a position, pixels per metre of `step`.
fn seen_step(at: vec3f, step: vec3f) -> vec2f {
    let right = frame.right.xyz * (0.5 * frame.right.w / dot(frame.right.xyz, frame.right.xyz));
    let up = frame.up.xyz * (0.5 * frame.up.w / dot(frame.up.xyz, frame.up.xyz));
    let straight = vec2(dot(step, right), dot(step, up));
    if is_from_above() {
        return straight;
    }
    let depth = dot(at, frame.forward.xyz);
    let seen = vec2(dot(at, right), dot(at, up)) / depth;
    return (straight - seen * dot(step, frame.forward.xyz)) / depth;
}

// Half the width of a deck at a position: the same rule as for roads on the ground, but constant
// over the whole cross-section.
fn half_width_at(road: Road, at: vec3f, along: vec3f) -> f32 {
    let distance_m = distance_to(at);
    let half_m = scaled_half_width_m(road, distance_m);
    let depth = select(dot(at, frame.forward.xyz), frame.network.w, is_from_above());
    var looks_m = least_half_width_m(road, max(depth, 0.0));
    if depth > frame.forward.w {
        let along_px = seen_step(at, along);
        let across_px = seen_step(at, vec3(-along.y, along.x, 0.0));
        let seen_px = abs(along_px.x * across_px.y - along_px.y * across_px.x) / max(length(along_px), 1e-9);
        let stretched_m = looks_m * stretch_of(distance_m, at.z);
        let least_px = frame.road_widths[road.class_number].y * px_share(road.class_number, road.look);
        looks_m = min(least_px / max(seen_px, 1e-9), stretched_m);
    }
    // At most as wide as roads on the ground.
    return min(part_share(road, distance_m) * max(half_m, looks_m), tile.base.y);
}

// How far a drawn deck is extended where it comes down to the ground: as far as a carriageway of
// class 0 below it is drawn too wide.
fn approach_m(at: vec3f, deck_m: f32) -> f32 {
    let beneath = road_with(0u, CARRIAGEWAY, 0.0, frame.road_options.z);
    let wider_m = scaled_half_width_m(beneath, distance_to(at)) - TRUE_HALF_WIDTH_M * frame.road_options.z;
    // The edge of the road is added.
    let edge_m = 3.0 * pixel_m_at(distance_to(at));
    return select(0.0, min(WIDEST_BENEATH * wider_m + edge_m, deck_m), wider_m > 0.0);
}

// A deck that is shorter than the width of roads below it would cut them to pieces: in this case
// the more important road is on top.
fn is_short(at: vec3f, deck_m: f32) -> bool {
    let beneath = road_with(0u, PLAIN, 0.0, frame.road_options.z);
    return deck_m < SHORTEST_DECK * scaled_half_width_m(beneath, distance_to(at));
}

// The mitre, if it fits within the piece. Where a wide road turns around a narrow bend, the piece
// ends in a half disc instead.
fn mitre_within(mitre: vec2f, outward: vec2f, half_width_m: f32, length_m: f32) -> vec2f {
    let cosine = dot(mitre, outward);
    let sine = abs(mitre.x * outward.y - mitre.y * outward.x);
    return select(vec2(0.0), mitre, half_width_m * sine <= length_m * cosine);
}

@vertex
fn vertex(in: DeckIn) -> DeckFragment {
    let vertical_scale = frame.scale.y;
    let stretched = vec3(1.0, 1.0, vertical_scale);
    let look = (in.class_and_look >> 4u) & 7u;
    var road = road_with(in.class_and_look & 15u, look, in.own_width, in.slab_width_factor.y);
    road.part_m = in.lengths.x;
    var out: DeckFragment;
    out.start = tile.offset.xyz + in.start_in_tile * stretched;
    out.start_to_end = (in.end_in_tile - in.start_in_tile) * stretched;
    let length_m = length(out.start_to_end.xy);
    let direction = direction_of(out.start_to_end.xy, length_m);
    let along = vec3(direction, select(0.0, out.start_to_end.z / length_m, length_m > 1e-6));
    // The road below is drawn too wide, too, and must not separate the bridge from its own road.
    let lands = vec2((in.class_and_look & 128u) != 0u, (in.class_and_look & 256u) != 0u);
    let before_m = select(0.0, approach_m(out.start, in.lengths.y), lands.x);
    let after_m = select(0.0, approach_m(out.start + out.start_to_end, in.lengths.y), lands.y);
    out.start -= vec3(direction * before_m, 0.0);
    out.start_to_end += vec3(direction * (before_m + after_m), 0.0);
    let end = out.start + out.start_to_end;
    let reached_m = length_m + before_m + after_m;
    out.size = vec3(half_width_at(road, out.start, along), half_width_at(road, end, along),
        select(in.slab_width_factor.x * vertical_scale, RIBBON_M, is_ribbon(in.class_and_look)));
    out.mitres = vec4(
        select(mitre_within(in.mitres.xy, -direction, out.size.x, reached_m), -direction, before_m > 0.0),
        select(mitre_within(in.mitres.zw, direction, out.size.y, reached_m), direction, after_m > 0.0),
    );
    out.class_and_look = in.class_and_look;
    out.half_width_m = road.half_width_m;
    out.dash = vec2(in.dash.x - in.dash.y * before_m, in.dash.y);
    out.part_m = in.lengths.x;
    out.is_short = select(0u, 1u, is_short(out.start, in.lengths.y));

    let widest_m = max(out.size.x, out.size.y);
    let pad_m = 1e-6 * max(length(out.start), length(end)) + 0.01;
    let low = min(out.start.z, end.z) - out.size.z - pad_m;
    let high = max(out.start.z, end.z) + highest_ground_m(widest_m, in.class_and_look) + pad_m;
    out.clip = box_corner(in.corner, out.start.xy, out.start_to_end.xy, direction, widest_m + pad_m, vec2(low, high));
    return out;
}

// Maximum height above the road of ground that is painted as the road.
fn highest_ground_m(half_width_m: f32, class_and_look: u32) -> f32 {
    return select(2.0 * half_width_m, OVER_RIBBON_M, is_ribbon(class_and_look)) * frame.scale.y;
}

const NONE = 0u;
const TOP = 1u;
const SIDE = 2u;
const UNDERSIDE = 3u;
// The ray leaves another part of the deck, or enters at its end.
const INNER = 4u;

// The depth range of a ray within a convex body. `face` is the face through which it enters.
struct Inside {
    enter: f32,
    exit: f32,
    face: u32,
}

// The part of the range in which `first + depth · each` is at most 0.
fn cut(inside: Inside, first: f32, each: f32, face: u32) -> Inside {
    var out = inside;
    if each > 0.0 {
        out.exit = min(out.exit, -first / each);
    } else if each < 0.0 {
        let enter = -first / each;
        if enter > out.enter {
            out.enter = enter;
            out.face = face;
        }
    } else if first > 0.0 {
        out.exit = -NEVER;
    }
    return out;
}

// The part of the range within a disc around the origin of `origin`.
fn cut_by_disc(inside: Inside, origin: vec2f, way: vec2f, radius_m: f32) -> Inside {
    var out = inside;
    let squared = dot(way, way);
    if squared < 1e-12 {
        if dot(origin, origin) > radius_m * radius_m {
            out.exit = -NEVER;
        }
        return out;
    }
    // Computed from the point of the ray that is nearest to the disc's centre, because the
    // difference of two large squares would be imprecise.
    let nearest = -dot(origin, way) / squared;
    let beside = origin + nearest * way;
    let rest = radius_m * radius_m - dot(beside, beside);
    if rest < 0.0 {
        out.exit = -NEVER;
        return out;
    }
    let half = sqrt(rest / squared);
    if nearest - half > out.enter {
        out.enter = nearest - half;
        out.face = SIDE;
    }
    out.exit = min(out.exit, nearest + half);
    return out;
}

// The part of the range within a round cap around the origin of `origin`.
fn cut_by_cap(inside: Inside, origin: vec3f, way: vec3f, radius_m: f32, slab_m: f32) -> Inside {
    let in_disc = cut_by_disc(inside, origin.xy, way.xy, radius_m);
    return cut(cut(in_disc, -origin.z - slab_m, -way.z, UNDERSIDE), origin.z, way.z, TOP);
}

fn first_depth() -> f32 {
    return select(0.0, -NEVER, is_from_above());
}

fn nearer(a: Inside, b: Inside) -> Inside {
    if b.exit < b.enter || b.exit < first_depth() {
        return a;
    }
    if a.exit < a.enter || b.enter < a.enter || (b.enter == a.enter && b.face < a.face) {
        return b;
    }
    return a;
}

// The point where the ray through a pixel enters a piece of a deck.
fn entry(in: DeckFragment, center: vec2f) -> Inside {
    let way = ray_at(center);
    let origin = ray_start_at(center) - in.start;
    let length_m = length(in.start_to_end.xy);
    let direction = direction_of(in.start_to_end.xy, length_m);
    let normal = vec2(-direction.y, direction.x);
    let o = vec2(dot(origin.xy, direction), dot(origin.xy, normal));
    let w = vec2(dot(way.xy, direction), dot(way.xy, normal));
    // The part between the mitres. In a view from above, heights may be exaggerated so much that a
    // deck is above the plane of the eye.
    var all = Inside(first_depth(), NEVER, INNER);
    all = cut(all, dot(origin.xy, in.mitres.xy), dot(way.xy, in.mitres.xy), INNER);
    all = cut(all, dot(origin.xy - in.start_to_end.xy, in.mitres.zw), dot(way.xy, in.mitres.zw), INNER);
    var found = Inside(NEVER, -NEVER, NONE);
    if length_m > 1e-6 {
        let rise = in.start_to_end.z / length_m;
        let wider = (in.size.y - in.size.x) / length_m;
        let over = vec2(origin.z - rise * o.x, way.z - rise * w.x);
        var middle = cut(all, -o.x, -w.x, INNER);
        middle = cut(middle, o.x - length_m, w.x, INNER);
        middle = cut(middle, o.y - in.size.x - wider * o.x, w.y - wider * w.x, SIDE);
        middle = cut(middle, -o.y - in.size.x - wider * o.x, -w.y - wider * w.x, SIDE);
        middle = cut(middle, -over.x - in.size.z, -over.y, UNDERSIDE);
        found = cut(middle, over.x, over.y, TOP);
    }
    if has_caps() {
        let first = cut(all, o.x, w.x, INNER);
        found = nearer(found, cut_by_cap(first, origin, way, in.size.x, in.size.z));
        let last = cut(all, length_m - o.x, -w.x, INNER);
        found = nearer(found, cut_by_cap(last, origin - in.start_to_end, way, in.size.y, in.size.z));
    }
    return found;
}

// A position in plan relative to a piece.
struct Beside {
    // Distance from the segment as a share of half the width there; more than 1 outside.
    share: f32,
    // Height of the road there, relative to the eye.
    road_z: f32,
    half_width_m: f32,
}

fn beside(in: DeckFragment, at: vec2f) -> Beside {
    let from_start = at - in.start.xy;
    let along = dot(from_start, in.start_to_end.xy) / max(dot(in.start_to_end.xy, in.start_to_end.xy), 1e-12);
    let share = clamp(along, 0.0, 1.0);
    let half_m = mix(in.size.x, in.size.y, share);
    var out = Beside(length(from_start - share * in.start_to_end.xy) / max(half_m, 1e-9),
        in.start.z + share * in.start_to_end.z, half_m);
    let is_beyond = dot(from_start, in.mitres.xy) > 0.0
        || dot(from_start - in.start_to_end.xy, in.mitres.zw) > 0.0
        || (!has_caps() && share != along);
    if is_beyond || half_m == 0.0 {
        out.share = NEVER;
    }
    return out;
}

// The ends of pieces are drawn this share farther away.
const BEHIND = 2e-5;

// The visible part of a piece at a pixel.
struct Seen {
    face: u32,
    view_depth: f32,
    position: vec3f,
    // Same as in Beside.
    share: f32,
}

fn seen_at(in: DeckFragment) -> Seen {
    let center = in.clip.xy;
    let ground = textureLoad(terrain_depth, vec2i(center), 0).r;
    let ground_depth = select(NEVER, view_depth_of(ground), ground > 0.0);
    let found = entry(in, center);
    var out = Seen(NONE, NEVER, vec3(0.0), NEVER);
    // An eye within a slab does not see the slab.
    let is_met = found.enter <= found.exit && found.exit >= first_depth() && found.enter <= ground_depth
        && (found.face != INNER || found.enter > frame.forward.w);
    if is_met {
        out.face = found.face;
        out.view_depth = found.enter;
        if found.face == INNER {
            // If no piece continues here, the end is closed like a side. Otherwise the next piece
            // is nearer.
            out.face = SIDE;
            out.view_depth = found.enter * (1.0 + BEHIND);
        }
    } else if ground > 0.0 {
        out.view_depth = ground_depth;
    } else {
        return out;
    }
    out.position = ray_start_at(center) + ray_at(center) * out.view_depth;
    let near = beside(in, out.position.xy);
    out.share = near.share;
    if out.face == NONE && near.share <= 1.0 {
        let above_m = out.position.z - near.road_z;
        if above_m >= -in.size.z && above_m <= highest_ground_m(near.half_width_m, in.class_and_look) {
            out.face = TOP;
        }
    }
    if !is_shown(deck_road(in), distance_to(out.position)) {
        out.face = NONE;
    }
    return out;
}

fn deck_road(in: DeckFragment) -> Road {
    return Road(in.class_and_look & 15u, (in.class_and_look >> 4u) & 7u, in.half_width_m, in.part_m);
}

@fragment
fn depth_fragment(in: DeckFragment) -> @builtin(frag_depth) f32 {
    let seen = seen_at(in);
    if seen.face == NONE {
        discard;
    }
    return depth_buffer_of(seen.view_depth);
}

@fragment
fn road_fragment(in: DeckFragment) -> @location(0) f32 {
    let seen = seen_at(in);
    if seen.face != TOP {
        discard;
    }
    let front = view_depth_of(textureLoad(deck_depth, vec2i(in.clip.xy), 0).r);
    let ray = ray_at(in.clip.xy);
    let apart_m = SAME_HEIGHT_M * frame.scale.y / max(abs(ray.z), 0.1 * length(ray));
    if seen.view_depth > front + apart_m + 2e-6 * abs(front) {
        discard;
    }
    let road = deck_road(in);
    let bands = band_count(road);
    var within = 0u;
    while within < bands && seen.share <= band_share(road.class_number, within) {
        within++;
    }
    // Rounding may place the edge of the road just outside.
    let label = band_label(road, max(within, 1u));
    let as_road = RoadFragment(in.clip, in.start.xy, in.start_to_end.xy, in.class_and_look, in.half_width_m, in.dash, in.part_m);
    let shown = label_on(label, as_road, seen.position);
    if in.is_short == 1u && stored(label) < textureLoad(ground_labels, vec2i(in.clip.xy), 0).r {
        discard;
    }
    // The slab is visible in the gaps between dashes.
    return stored(select(shown, SIDE_LABEL, shown == NOTHING));
}

@fragment
fn side_fragment(in: DeckFragment) -> @location(0) f32 {
    let seen = seen_at(in);
    if (seen.face != SIDE && seen.face != UNDERSIDE) || in.is_short == 1u {
        discard;
    }
    let front = view_depth_of(textureLoad(deck_depth, vec2i(in.clip.xy), 0).r);
    if seen.view_depth > front + 2e-6 * abs(front) {
        discard;
    }
    return stored(select(SIDE_LABEL, UNDERSIDE_LABEL, seen.face == UNDERSIDE));
}
