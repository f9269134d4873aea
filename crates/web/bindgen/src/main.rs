//! `bindgen INPUT.wasm FOLDER`: does the same as `wasm-bindgen --target web`.

use std::{env, error::Error};

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let (Some(input), Some(folder), None) = (arguments.next(), arguments.next(), arguments.next()) else {
        return Err("usage: bindgen INPUT.wasm FOLDER".into());
    };
    Bindgen::new().input_path(input).typescript(true).web(true)?.generate(folder)?;
    Ok(())
}
