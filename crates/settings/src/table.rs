//! The table of settings.

/// Passes the table of all settings to the macro `then`, followed by `args`: `settings! { [then]
/// args }`.
///
/// Sections are those of settings files; settings come in the order of the help. A setting is
///
/// ```text
/// /// Help, with [default: …].
/// #[arg(…)] #[serde(…)]           attributes for clap and serde, in `presets`
/// name: Type                      the option
///     , check function            of `presets`, which rejects values
///     , rival name                an alternative: if one is given, neither is merged from the file
///     => { RECORD };              if it determines bytes
/// ```
///
/// and the record of what determines bytes is
///
/// ```text
/// /// The description in the JSON schema.
/// ["--flag"]                      names in comparisons; `as function` formats the text
/// key: Type                       in the manifest
///     , left_out "is_default"     new keys are omitted at their default, so that hashes stay
///     , within LOW..=HIGH         limits of numbers
///     , at path.of.field          in the checked settings of `spec`
///     , usual VALUE               the default there, if it is not that of the type
/// ```
///
/// After `and` come values that are recorded but are not options. A new record needs a line in
/// FORMAT.md, and a new option one in `config/build.toml`.
#[macro_export]
macro_rules! settings {
    ([$($then:tt)+] $args:tt) => { $($then)+! { $args

Inputs(InputFiles) {
    /// The DEM: elevation files in any format that GDAL reads; where they overlap, the first has
    /// precedence. FILE can also be a folder, a pattern such as 'a/*.tif', @LIST (a text file with
    /// one name per line), an archive (.gz, .zip), or an address (https://, s3://)
    #[arg(
        long, value_name = "FILE", num_args = 1..,
        required_unless_present_any = ["terrain_of", "config"]
    )]
    #[serde(deserialize_with = "one_or_many_names")]
    dem: Vec<PathBuf>, rival terrain;
    /// Take the terrain from this package instead of a DEM; the build is faster, and gives the same
    /// new package as a build from the DEM. Terrain settings are also taken from the old package
    /// (different ones are rejected), and so is the attribution, unless you pass another. The old
    /// package must come from the same version of the program
    #[arg(id = "terrain_of", long = "terrain", value_name = "PACKAGE", conflicts_with = "dem")]
    terrain: Option<PathBuf>, rival dem;
    /// OpenStreetMap extract (.osm.pbf), or several; an object that is in more than one is used
    /// once. Also folders, patterns and @LIST, as for --dem. Without an extract the package has
    /// only terrain
    #[arg(long, value_name = "FILE", num_args = 1..)]
    #[serde(deserialize_with = "one_or_many_names")]
    osm: Vec<PathBuf>;
    /// Convert only the area of the polygons in this vector file (any format that GDAL reads; all
    /// polygons are used). The terrain extends less than a cell beyond the polygons, roads are
    /// clipped to them, and the grid is that of the whole DEM. With --bounds, only the intersection
    /// is converted
    #[arg(long, value_name = "FILE")]
    polygon: Option<PathBuf>;
    /// Photos of the ground from above (orthophotos) to drape on the terrain: 8-bit RGB, grey or
    /// palette, in any format and CRS that GDAL reads; where they overlap, the first is on top.
    /// Also folders, patterns, @LIST, archives and addresses, as for --dem. The word off: no photos
    /// [default: those of --terrain, else none]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    #[serde(deserialize_with = "one_or_many_names")]
    photo: Vec<PathBuf>;
} and {}
Terrain(TerrainOptions, "Terrain") {
    /// Working CRS: dem (that of the first file, whose samples are then the nodes of the grid),
    /// utm, or any projected CRS [default: dem if lengths in it are true within 3 %, else utm]
    #[arg(long, value_name = "dem|utm|EPSG:N|WKT")]
    crs: Option<String> => {
        /// `--crs`, if given.
        ["--crs"] crs: Option<String>, at plan.crs
    };
    /// Band of the heights, counted from 1, in files with several bands [default: the only one]
    #[arg(long, value_name = "N")]
    dem_band: Option<u32> => {
        /// `--dem-band`, if given.
        ["--dem-band"] dem_band: Option<u32>, left_out "is_default", at open.band
    };
    /// Allow PROJ's ballpark transformations (no datum shift). Roads can then be off by 100 m or
    /// more
    #[arg(long)]
    allow_ballpark: bool;
    /// CRS of elevation files that do not define one
    #[arg(long, value_name = "EPSG:N")]
    dem_crs: Option<String> => {
        /// `--dem-crs`, if given.
        ["--dem-crs"] dem_crs: Option<String>, at open.dem_crs
    };
    /// Vertical CRS of elevation files that do not define one
    #[arg(long, value_name = "EPSG:N")]
    dem_vertical_crs: Option<String> => {
        /// `--dem-vertical-crs`, if given.
        ["--dem-vertical-crs"] dem_vertical_crs: Option<String>, at open.dem_vertical_crs
    };
    /// Vertical CRS to convert heights to, with PROJ and its geoid grids [default: no conversion]
    #[arg(long, value_name = "EPSG:N")]
    vertical_crs: Option<String> => {
        /// `--vertical-crs`, if given.
        ["--vertical-crs"] vertical_crs: Option<String>, at open.vertical_crs
    };
    /// Value to add to every height, in metres [default: 0]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    vertical_shift: Option<f64> => {
        /// `--vertical-shift`; 0 when not given.
        ["--vertical-shift"] vertical_shift_m: f64,
        within -MAX_MEASURE_M..=MAX_MEASURE_M, at open.vertical_shift_m
    };
    /// Unit of the heights in all files, whatever the files say: metre, foot, us-foot, decimetre or
    /// centimetre [default: that of their bands or vertical CRS, else metre]
    #[arg(long, value_name = "UNIT")]
    vertical_unit: Option<String> => {
        /// `--vertical-unit`, if given.
        ["--vertical-unit"] vertical_unit: Option<String>,
        left_out "is_default", at open.vertical_unit
    };
    /// Additional nodata value, as stored in the files; may be given several times
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_many")]
    nodata: Option<Vec<f64>>, check check_nodata => {
        /// Each `--nodata`, in their order.
        ["--nodata"] nodata: Vec<f64>, within f64::MIN..=f64::MAX, at open.nodata
    };
    /// Range of valid heights, in metres, before --vertical-shift; if given, every value within it
    /// is a height, even one that looks like nodata [default: -12000,9000, excluding usual nodata
    /// values and a repeated value 1000 m beyond all others]
    #[arg(long, value_name = "LOW,HIGH", value_parser = parse_range, allow_hyphen_values = true)]
    height_range: Option<[f64; 2]>, check check_height_range => {
        /// `--height-range`, if given.
        ["--height-range"] height_range_m: Option<[f64; 2]>,
        within -MAX_MEASURE_M..=MAX_MEASURE_M, at height_range_m
    };
    /// Latitude at which lengths are true, if the working CRS is not true to scale (such as
    /// EPSG:4326 or EPSG:3857). Packages of adjoining regions fit together if they use the same
    /// latitude [default: the middle of the DEM, rounded to half a degree]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    scale_latitude: Option<f64> => {
        /// `--scale-latitude`, if given.
        ["--scale-latitude"] scale_latitude_deg: Option<f64>, at plan.scale_latitude_deg
    };
    /// Cell size of the finest level, in metres: one number for squares, or two for rectangles
    /// (east, north); heights are interpolated [default: that of the DEM]
    #[arg(
        long, value_name = "METRES|EAST,NORTH", value_parser = parse_cell,
        allow_hyphen_values = true
    )]
    #[serde(deserialize_with = "one_or_two")]
    cell: Option<Cell>, check check_cells, rival cell_every => {
        /// `--cell`, if given, east and north.
        ["--cell"] cell_m: Option<Cell>, within f64::MIN_POSITIVE..=MAX_MEASURE_M, at plan.cell
    };
    /// Use every K-th sample of the DEM along both axes as a node of the finest level, without
    /// interpolation
    #[arg(long, value_name = "K", conflicts_with = "cell")]
    cell_every: Option<u32>, rival cell => {
        /// `--cell-every`, if given.
        ["--cell-every"] cell_every: Option<u32>, at plan.cell_every
    };
    /// Largest vertical error of the finest level, in metres [default: a 16th of the cell size;
    /// 0.25 for cells of 1 to 4 m]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    max_error: Option<f64>, check check_max_error => {
        /// `--max-error`.
        ["--max-error"] max_error_m: f64, within 0.0..=MAX_MEASURE_M
    };
    /// Fill voids (nodata) that have data within this many cells in each of eight directions
    /// [default: 32]
    #[arg(long, value_name = "CELLS")]
    fill_voids: Option<u32> => {
        /// `--fill-voids`.
        ["--fill-voids"] fill_voids: u32, at plan.fill_voids, usual 32
    };
    /// Levels that also store their raster of heights for shading (the relief): off, finest or full
    /// (all levels). Shading then shows detail that the triangles lack, because they only stay
    /// within --max-error of the heights [default: full]
    #[arg(
        long, value_name = "off|finest|full", hide_possible_values = true,
        value_parser = one_of(RELIEF)
    )]
    relief: Option<ReliefLevels> => {
        /// `--relief`: off, finest or full.
        ["--relief"] relief: ReliefLevels,
        left_out "is_default", at relief, usual ReliefLevels::Full
    };
    /// Convert only what is within these bounds: west, south, east and north in WGS84 degrees,
    /// across 180° if west > east; or osm: the bounding box in the extract's header, extended by
    /// 1 % on every side. Terrain and roads are clipped to the bounds, which are rounded outwards
    /// to whole cells; the grid is that of the whole DEM
    #[arg(
        long, value_name = "W,S,E,N|osm", value_parser = BoundsChoice::parse,
        allow_hyphen_values = true
    )]
    bounds: Option<BoundsChoice> => {
        /// `--bounds`: west, south, east and north in WGS84 degrees; omitted where not given.
        ["--bounds"] bounds_deg: Option<[f64; 4]>,
        left_out "is_default", within -360.0..=360.0, at plan.bounds_deg
    };
    /// Attribution; on the command line, this option is among the inputs.
    #[arg(skip)]
    attribution: Vec<String>;
} and {
    {
        /// `--polygon`; omitted where not given.
        ["--polygon"] polygon: Option<PolygonRecord>, left_out "is_default"
    }
}
Roads(RoadOptions, "Roads") {
    /// FRC table, which assigns roads to functional road classes: a preset (default, valhalla,
    /// fraunhofer, itinero, here5) or a TOML file [default: the preset named default]
    #[arg(long, value_name = "PRESET|FILE")]
    frc_table: Option<String> => {
        /// Name of the FRC table.
        ["--frc-table"] frc_table: String
    };
    /// Functional road classes (FRC) to convert, such as 0-8 or motorway,1,2; other roads are
    /// skipped, and counted with their lengths. 0 is motorways, 7 service roads and tracks, 8 ways
    /// for pedestrians, riders and cyclists [default: those that the FRC table turns on, 0-7 in the
    /// default table]
    #[arg(long, value_name = "LIST", value_parser = Classes::parse)]
    classes: Option<Classes> => {
        /// `--classes`: the classes that become roads; omitted where the table decides.
        ["--classes"] classes: Option<Vec<u8>>, left_out "is_default"
    };
    /// Show every class that is on (see --classes) on every level; by default, coarse levels show
    /// only important classes
    #[arg(long)]
    all_classes: bool;
    /// Tolerance for simplifying roads on coarser levels, in cells of the level; 0 keeps every
    /// point [default: 0.25]
    // Where a level is drawn, its cells have a size of one or two pixels, so a quarter of a cell is
    // invisible.
    #[arg(long, value_name = "CELLS")]
    simplify: Option<f64>, check check_simplify => {
        /// Simplification tolerance in cells of the level; 0 turns simplification off.
        ["--simplify"] simplify_cells: f64,
        within 0.0..=MAX_MEASURE_M, at simplify_cells, usual 0.25
    };
    /// Bridges and tunnels: ground (draped on the terrain, like all roads) or spans (also stored at
    /// estimated heights, above or below the terrain) [default: spans]
    #[arg(
        id = "structures", long = "structures", value_name = "ground|spans",
        value_parser = either(["ground", "spans"])
    )]
    #[serde(rename = "structures", deserialize_with = "ground_or_spans")]
    spans: Option<bool> => {
        /// Whether bridges and tunnels leave the ground; omitted if they do not.
        ["--structures" as structures_text] spans: bool, left_out "is_default", at spans, usual true
    };
    /// Coarsest cell, metres, at which each class is shown; a class that is not listed is shown on
    /// every level.
    #[arg(skip)]
    class_max_cell: Option<BTreeMap<String, f64>> => {
        /// Coarsest cell, metres, at which each class is still shown, class 0 first; null: on every
        /// level.
        ["class-max-cell (--all-classes)" as class_cells_text]
        class_max_cell_m: Vec<Option<f64>>, within 0.0..=MAX_MEASURE_M
    };
} and {
    {
        /// SHA-256 of the FRC table's text.
        // The entries of the table are compared one by one.
        [] frc_table_sha256: String
    }
    {
        /// The labels of the classes, class 0 first; omitted for FRC tables that come with the
        /// program.
        ["the names of classes"] class_labels: Option<Vec<String>>, left_out "is_default"
    }
}
Layers(LayerOptions, "Layers") {
    /// Layers of the extract to store: built-in ones such as areas, waterways and buildings
    /// (`corniche layers` lists them), or tables of your own (TOML files); separate several by
    /// commas. The word none: no layers [default: none]
    #[arg(id = "layers", long = "layers", value_name = "NAME|FILE|none", value_delimiter = ',')]
    #[serde(rename = "layers", deserialize_with = "one_or_many_names")]
    tables: Vec<String> => {
        /// The tables of the layers, the lowest layer first; omitted without layers.
        ["--layers"] layers: Vec<LayerTableRecord>, left_out "is_default"
    };
} and {}
Photo(PhotoOptions, "Photos") {
    /// Number of photo levels that are finer than the finest cell, 0 to 4: with 3 a cell has 8 × 8
    /// texels [default: the detail of the finest photo, at most 3]
    #[arg(id = "photo_levels", long = "photo-levels", value_name = "N")]
    levels: Option<u8>;
    /// JPEG quality of the photos, 1 to 100 [default: 80]
    #[arg(id = "photo_quality", long = "photo-quality", value_name = "Q")]
    quality: Option<u8>;
    /// Attribution of the photos, displayed wherever the package is shown, in addition to that in
    /// the files (GeoTIFF's tag Copyright)
    #[arg(id = "photo_attribution", long = "photo-attribution", value_name = "TEXT")]
    attribution: Option<String>;
} and {
    {
        /// How photos are stored; omitted without photos.
        ["--photo-levels" as photo_levels_text, "--photo-quality" as photo_quality_text]
        photo: Option<PhotoRecord>, left_out "is_default"
    }
}
Resources(ResourceOptions, "Resources") {
    /// Number of worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>;
    /// Memory limit, at least 256M, such as 512M or 4G (M is 2^20 bytes, MB is 10^6) [default: half
    /// of the machine's memory, at most 4G]
    #[arg(long, value_name = "BYTES")]
    memory: Option<String>;
    /// Folder for intermediate results, which need far more space than the package [default: the
    /// folder of the package]
    #[arg(long, value_name = "FOLDER")]
    tmp: Option<PathBuf>;
} and {}
} };
}

/// The manifest's keys in the order of all packages so far: hashes depend on it. New keys follow in
/// the order of the table.
pub(crate) const KEYS_IN_ORDER: &str = "max_error_m fill_voids nodata height_range_m dem_band dem_crs \
    dem_vertical_crs vertical_crs \
    vertical_shift_m vertical_unit crs cell_m cell_every scale_latitude_deg bounds_deg polygon \
    relief frc_table frc_table_sha256 class_labels classes class_max_cell_m simplify_cells photo \
    layers spans";

/// Passes the records of all settings that determine bytes to the macro `then`, each as `Section {
/// RECORD }`: `recorded! { [then] }`.
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

/// Passes each setting of a section that has a place in the checked settings to the macro `then`:
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
