//! The table of settings.

/// Gives the table of all settings to the macro `then`, behind `args`: `settings! { [then] args }`.
///
/// Sections are those of settings files; settings come in the order of the help. A setting is
///
/// ```text
/// /// Help, with [default: …].
/// #[arg(…)] #[serde(…)]           as clap and serde read it, in `presets`
/// name: Type                      the option
///     , check function            of `presets`, which refuses values
///     , rival name                gives the same thing: of the two, none is taken from elsewhere
///     => { RECORD };              if it determines bytes
/// ```
///
/// and the record of what determines bytes is
///
/// ```text
/// /// What the JSON schema says.
/// ["--flag"]                      names in comparisons; `as function` makes a text of its own
/// key: Type                       in the manifest
///     , left_out "is_default"     new keys are left out at their default, so that hashes hold
///     , within LOW..=HIGH         numbers that may be read
///     , at path.of.field          in the checked settings of `spec`
///     , usual VALUE               the default there, if it is not that of the type
/// ```
///
/// Below `and` is recorded what is no option. A new record needs a line in FORMAT.md, and a new
/// option one in `config/build.toml`.
#[macro_export]
macro_rules! settings {
    ([$($then:tt)+] $args:tt) => { $($then)+! { $args

Inputs(InputFiles) {
    /// Elevation rasters, any format GDAL reads; where they overlap, the first has precedence. Also
    /// folders, patterns such as 'a/*.tif', @LIST (a text file with a name on each line), .gz,
    /// .zip, and https:// and s3:// addresses
    #[arg(
        long, value_name = "FILE", num_args = 1..,
        required_unless_present_any = ["terrain_of", "config"]
    )]
    #[serde(deserialize_with = "one_or_many_names")]
    dem: Vec<PathBuf>, rival terrain;
    /// Take the terrain of this package, made by the same program with the same terrain settings,
    /// in place of elevation rasters; the result is the same, sooner. Terrain settings and credits
    /// that are not given are the package's
    #[arg(id = "terrain_of", long = "terrain", value_name = "PACKAGE", conflicts_with = "dem")]
    terrain: Option<PathBuf>, rival dem;
    /// OpenStreetMap extract (.osm.pbf), or several: what is in two of them counts once. Also
    /// folders, patterns and @LIST. Without it the package is terrain alone
    #[arg(long, value_name = "FILE", num_args = 1..)]
    #[serde(deserialize_with = "one_or_many_names")]
    osm: Vec<PathBuf>;
    /// Convert only what lies under the polygons of this vector file (any format GDAL reads; all of
    /// its polygons together). Ground reaches less than a cell beyond them, roads end at them; the
    /// grid is that of the whole DEM. With --bounds, both hold
    #[arg(long, value_name = "FILE")]
    polygon: Option<PathBuf>;
    /// Photos of the ground from above (orthophotos) to lay on it: 8-bit colours, grey or palette,
    /// any format and CRS that GDAL reads; where they overlap, the first lies on top. Also folders,
    /// patterns, @LIST, archives and addresses, as for --dem. off: none [default: those of
    /// --terrain, else none]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    #[serde(deserialize_with = "one_or_many_names")]
    photo: Vec<PathBuf>;
} and {}
Terrain(TerrainOptions, "Terrain") {
    /// Working CRS: dem (the first raster's own, so that nodes are its samples), utm, or any
    /// projected one [default: dem where lengths are then true within 3 %, else utm]
    #[arg(long, value_name = "dem|utm|EPSG:N|WKT")]
    crs: Option<String> => {
        /// `--crs`, if given.
        ["--crs"] crs: Option<String>, at plan.crs
    };
    /// Band with the heights, from 1 on, of rasters with several [default: the only one]
    #[arg(long, value_name = "N")]
    dem_band: Option<u32> => {
        /// `--dem-band`, if given.
        ["--dem-band"] dem_band: Option<u32>, left_out "is_default", at open.band
    };
    /// Take one datum for another where PROJ knows nothing between them, which can put roads 100 m
    /// and more beside the ground
    #[arg(long)]
    allow_ballpark: bool;
    /// CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    dem_crs: Option<String> => {
        /// `--dem-crs`, if given.
        ["--dem-crs"] dem_crs: Option<String>, at open.dem_crs
    };
    /// Vertical CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    dem_vertical_crs: Option<String> => {
        /// `--dem-vertical-crs`, if given.
        ["--dem-vertical-crs"] dem_vertical_crs: Option<String>, at open.dem_vertical_crs
    };
    /// Vertical CRS to convert heights to, with PROJ and its geoid grids [default: that of the
    /// files]
    #[arg(long, value_name = "EPSG:N")]
    vertical_crs: Option<String> => {
        /// `--vertical-crs`, if given.
        ["--vertical-crs"] vertical_crs: Option<String>, at open.vertical_crs
    };
    /// Added to every height, in metres [default: 0]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    vertical_shift: Option<f64> => {
        /// `--vertical-shift`; 0 when not given.
        ["--vertical-shift"] vertical_shift_m: f64,
        within -MAX_MEASURE_M..=MAX_MEASURE_M, at open.vertical_shift_m
    };
    /// Unit of the heights of all rasters, whatever they say of it: metre, foot, us-foot, decimetre
    /// or centimetre [default: that of their bands or vertical CRS, else metre]
    #[arg(long, value_name = "UNIT")]
    vertical_unit: Option<String> => {
        /// `--vertical-unit`, if given.
        ["--vertical-unit"] vertical_unit: Option<String>,
        left_out "is_default", at open.vertical_unit
    };
    /// Value that means "no data", as stored in the files, besides the one they declare; may be
    /// given several times
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_many")]
    nodata: Option<Vec<f64>>, check check_nodata => {
        /// Each `--nodata`, in their order.
        ["--nodata"] nodata: Vec<f64>, within f64::MIN..=f64::MAX, at open.nodata
    };
    /// Heights that samples may have, in metres, before --vertical-shift; every value in this range
    /// counts as a height [default: -12000,9000, and neither a usual value for "no data" nor a
    /// repeated one 1000 m beyond all others]
    #[arg(long, value_name = "LOW,HIGH", value_parser = parse_range, allow_hyphen_values = true)]
    height_range: Option<[f64; 2]>, check check_height_range => {
        /// `--height-range`, if given.
        ["--height-range"] height_range_m: Option<[f64; 2]>,
        within -MAX_MEASURE_M..=MAX_MEASURE_M, at height_range_m
    };
    /// Latitude, in degrees, at which lengths are true in a CRS that is not true to scale, such as
    /// degrees; packages of adjoining regions fit when it is the same [default: the middle of the
    /// DEM, to half a degree]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    scale_latitude: Option<f64> => {
        /// `--scale-latitude`, if given.
        ["--scale-latitude"] scale_latitude_deg: Option<f64>, at plan.scale_latitude_deg
    };
    /// Spacing of the finest level, in metres: of a square, or of a rectangle, east and north;
    /// heights are interpolated [default: the DEM's own]
    #[arg(
        long, value_name = "METRES|EAST,NORTH", value_parser = parse_cell,
        allow_hyphen_values = true
    )]
    #[serde(deserialize_with = "one_or_two")]
    cell: Option<Cell>, check check_cells, rival cell_every => {
        /// `--cell`, if given, east and north.
        ["--cell"] cell_m: Option<Cell>, within f64::MIN_POSITIVE..=MAX_MEASURE_M, at plan.cell
    };
    /// Take every K-th sample of the DEM along both axes as a node of the finest level, without
    /// interpolation
    #[arg(long, value_name = "K", conflicts_with = "cell")]
    cell_every: Option<u32>, rival cell => {
        /// `--cell-every`, if given.
        ["--cell-every"] cell_every: Option<u32>, at plan.cell_every
    };
    /// Largest vertical error of the finest level, in metres [default: a 16th of the cell; 0.25 for
    /// cells of 1 to 4 m]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    max_error: Option<f64>, check check_max_error => {
        /// `--max-error`.
        ["--max-error"] max_error_m: f64, within 0.0..=MAX_MEASURE_M
    };
    /// Fill voids that have data within this many cells in each of eight directions [default: 32]
    #[arg(long, value_name = "CELLS")]
    fill_voids: Option<u32> => {
        /// `--fill-voids`.
        ["--fill-voids"] fill_voids: u32, at plan.fill_voids, usual 32
    };
    /// Levels that store their rasters, compressed for shading: off, finest or full, which is all
    /// of them. The triangles stay within --max-error of heights; the relief shows what lies
    /// between them [default: full]
    #[arg(
        long, value_name = "off|finest|full", hide_possible_values = true,
        value_parser = one_of(RELIEF)
    )]
    relief: Option<ReliefLevels> => {
        /// `--relief`: off, finest or full.
        ["--relief"] relief: ReliefLevels,
        left_out "is_default", at relief, usual ReliefLevels::Full
    };
    /// Convert only what lies within these bounds: west, south, east and north in WGS84 degrees,
    /// across 180° where the west is larger than the east; or osm: where the extract is, by its
    /// header, and a hundredth more on every side. Ground and roads end at the bounds, rounded
    /// outwards to whole cells; the grid is that of the whole DEM
    #[arg(
        long, value_name = "W,S,E,N|osm", value_parser = BoundsChoice::parse,
        allow_hyphen_values = true
    )]
    bounds: Option<BoundsChoice> => {
        /// `--bounds`: west, south, east and north in WGS84 degrees; left out where not given.
        ["--bounds"] bounds_deg: Option<[f64; 4]>,
        left_out "is_default", within -360.0..=360.0, at plan.bounds_deg
    };
    /// Credits, which the command line has beside the inputs.
    #[arg(skip)]
    attribution: Vec<String>;
} and {
    {
        /// `--polygon`; left out where not given.
        ["--polygon"] polygon: Option<PolygonRecord>, left_out "is_default"
    }
}
Roads(RoadOptions, "Roads") {
    /// FRC table: a preset (default, valhalla, fraunhofer, itinero, here5) or a TOML file [default:
    /// default]
    #[arg(long, value_name = "PRESET|FILE")]
    frc_table: Option<String> => {
        /// Name of the FRC table.
        ["--frc-table"] frc_table: String
    };
    /// Functional road classes that become roads, such as 0-8 or 0,1,2; others are left out, and
    /// counted with their lengths. 0 is motorways, 7 service roads and tracks, 8 ways for people on
    /// foot, on horses or on bicycles [default: what the FRC table has on, 0-7 in the default one]
    #[arg(long, value_name = "LIST", value_parser = Classes::parse)]
    classes: Option<Classes> => {
        /// `--classes`: the classes that become roads; left out where the table decides.
        ["--classes"] classes: Option<Vec<u8>>, left_out "is_default"
    };
    /// Show every class that is on (see --classes) on every level; without it, coarse levels show
    /// important classes alone
    #[arg(long)]
    all_classes: bool;
    /// Tolerance of the simplification of roads on coarser levels, in cells of the level; 0 keeps
    /// every point [default: 0.25]
    // Where a level is drawn its cells have a pixel or two, and a quarter of one is not seen.
    #[arg(long, value_name = "CELLS")]
    simplify: Option<f64>, check check_simplify => {
        /// Simplification tolerance in cells of the level; 0 is off.
        ["--simplify"] simplify_cells: f64,
        within 0.0..=MAX_MEASURE_M, at simplify_cells, usual 0.25
    };
    /// Where bridges and tunnels are: spans, above and below the ground as well as on it; or on the
    /// ground alone. Heights of spans are estimates [default: spans]
    #[arg(
        id = "structures", long = "structures", value_name = "ground|spans",
        value_parser = either(["ground", "spans"])
    )]
    #[serde(rename = "structures", deserialize_with = "ground_or_spans")]
    spans: Option<bool> => {
        /// Whether bridges and tunnels leave the ground; left out without.
        ["--structures" as structures_text] spans: bool, left_out "is_default", at spans, usual true
    };
    /// Coarsest cell, metres, at which each class is shown; a class left out is shown on every
    /// level.
    #[arg(skip)]
    class_max_cell: Option<BTreeMap<String, f64>> => {
        /// Coarsest cell, metres, at which each class is still shown, class 0 first; null: on every level.
        ["class-max-cell (--all-classes)" as class_cells_text]
        class_max_cell_m: Vec<Option<f64>>, within 0.0..=MAX_MEASURE_M
    };
} and {
    {
        /// SHA-256 of the FRC table's text.
        // Its entries are compared one by one.
        [] frc_table_sha256: String
    }
    {
        /// What the roads of each class are called, class 0 first; left out for FRC tables that come with the program.
        ["the names of classes"] class_labels: Option<Vec<String>>, left_out "is_default"
    }
}
Areas(AreaOptions, "Areas") {
    /// Areas of the extract, such as water and forest, stored as polygons: the table of their
    /// classes, a preset (default) or a TOML file; off leaves them out [default: off]
    #[arg(id = "areas", long = "areas", value_name = "off|default|FILE")]
    #[serde(rename = "areas")]
    table: Option<String> => {
        /// Which objects are areas; left out without any.
        ["--areas"] areas: Option<AreaTableRecord>, left_out "is_default"
    };
    /// Boundaries of the extract: administrative ones of the levels 2 to 8, and those of protected
    /// areas, each shared border once; on or off [default: off]
    #[arg(long, value_name = "off|on", value_parser = either(["off", "on"]))]
    #[serde(deserialize_with = "off_or_on")]
    boundaries: Option<bool> => {
        /// Whether there are boundaries; left out without any.
        ["--boundaries"] boundaries: bool, left_out "is_default"
    };
} and {}
Photo(PhotoOptions, "Photos") {
    /// How many levels of texels are finer than the finest cell, 0 to 4: with 3 a cell has 8 × 8
    /// texels [default: as many as the finest photo has detail for, at most 3]
    #[arg(id = "photo_levels", long = "photo-levels", value_name = "N")]
    levels: Option<u8>;
    /// Quality of the photos' JPEG coding, 1 to 100 [default: 80]
    #[arg(id = "photo_quality", long = "photo-quality", value_name = "Q")]
    quality: Option<u8>;
    /// Credit of the photos, shown wherever the package is shown, beside those that their files
    /// have (GeoTIFF's tag Copyright)
    #[arg(id = "photo_attribution", long = "photo-attribution", value_name = "TEXT")]
    attribution: Option<String>;
} and {
    {
        /// How photos were made; left out without any.
        ["--photo-levels" as photo_levels_text, "--photo-quality" as photo_quality_text]
        photo: Option<PhotoRecord>, left_out "is_default"
    }
}
Resources(ResourceOptions, "Resources") {
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>;
    /// The most memory to use, such as 512M, 4G or 1T, at least 256M [default: half of the
    /// machine's, at most 4G]
    #[arg(long, value_name = "BYTES")]
    memory: Option<String>;
    /// Folder for intermediate results, which take far more space than the package [default: that
    /// of the package]
    #[arg(long, value_name = "FOLDER")]
    tmp: Option<PathBuf>;
} and {}
} };
}

/// The manifest's keys in the order in which packages have always had them: hashes depend on it. New
/// ones come behind them, in the order of the table.
pub(crate) const KEYS_IN_ORDER: &str = "max_error_m fill_voids nodata height_range_m dem_band dem_crs \
    dem_vertical_crs vertical_crs \
    vertical_shift_m vertical_unit crs cell_m cell_every scale_latitude_deg bounds_deg polygon \
    relief frc_table frc_table_sha256 class_labels classes class_max_cell_m simplify_cells photo \
    areas boundaries spans";

/// Gives the records of all settings that determine bytes to the macro `then`, each as
/// `Section { RECORD }`: `recorded! { [then] }`.
#[macro_export]
macro_rules! recorded {
    ([$($then:tt)+]) => {
        $crate::settings! { [$crate::recorded] ([$($then)+]) }
    };
    (
        ([$($then:tt)+])
        $(
            $section:ident $head:tt {
                $(
                    $(#[$($attr:tt)*])*
                    $name:ident: $type:ty $(, check $check:ident)? $(, rival $rival:ident)?
                    $(=> $record:tt)?;
                )*
            } and { $($other:tt)* }
        )*
    ) => {
        $($then)+! { $( $($( $section $record )?)* $( $section $other )* )* }
    };
}

/// Gives each setting of a section that has a place in the checked settings to the macro `then`:
/// `placed! { Section [then] args }` calls `then! { args name key [path.of.field] [usual value] }`.
#[macro_export]
macro_rules! placed {
    ($wanted:ident $then:tt $args:tt) => {
        $crate::settings! { [$crate::placed] ($wanted $then $args) }
    };
    (
        ($wanted:ident $then:tt $args:tt)
        $(
            $section:ident $head:tt {
                $(
                    $(#[$($attr:tt)*])*
                    $name:ident: $type:ty $(, check $check:ident)? $(, rival $rival:ident)? $(=> {
                        $(#[$($record_attr:tt)*])*
                        [$($flags:tt)*] $key:ident: $record_type:ty
                        $(, left_out $left_out:literal)? $(, within $range:expr)?
                        $(, at $($path:ident).+ $(, usual $usual:expr)?)?
                    })?;
                )*
            } and $others:tt
        )*
    ) => {
        $($($($crate::placed! {
            @ $wanted $section $then $args $name $key $([$($path).+] [$($usual)?])?
        })?)*)*
    };
    (@ Terrain Terrain [$($then:tt)+] $args:tt $name:ident $key:ident $path:tt $usual:tt) => {
        $($then)+! { $args $name $key $path $usual }
    };
    (@ Roads Roads [$($then:tt)+] $args:tt $name:ident $key:ident $path:tt $usual:tt) => {
        $($then)+! { $args $name $key $path $usual }
    };
    (@ $($other:tt)*) => {};
}
