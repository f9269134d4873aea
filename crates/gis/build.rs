//! Links the PROJ that GDAL works with: where pkg-config says it is, or else where the linker finds
//! it.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if pkg_config::probe_library("proj").is_err() {
        println!("cargo::rustc-link-lib=proj");
    }
}
