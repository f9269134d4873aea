# Sourced by scripts/web, scripts/test-web, scripts/test-npm and scripts/test-wheel: a compiler for WebAssembly, and what the tests of the page need.
# shellcheck shell=bash

WASM=wasm32-unknown-unknown

# Sets `web_cargo` to the command that builds for browsers. rustup's standard library is taken where there is one or it can be added, else Debian's
# compiler for browsers, which builds its own from source. Fails, and says why, where neither can be had.
find_web_cargo() {
    if [ -d "$(rustc --print sysroot)/lib/rustlib/$WASM" ] || { command -v rustup >/dev/null && rustup target add "$WASM" >&2; }; then
        web_cargo=(cargo build --locked --target "$WASM")
        return 0
    fi
    if ! (install_missing missing_for_debian_web); then
        say "neither rustup's standard library for $WASM nor Debian's rustc-web can be installed here"
        return 1
    fi
    # Building the standard library is not stable yet; this is how Debian's compiler is told to do it all the same.
    web_cargo=(env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld
        /usr/bin/cargo build --locked --target "$WASM" -Zbuild-std=std,panic_abort)
}

# The compiler of `web_cargo`, in a line.
web_compiler() {
    case ${web_cargo[0]} in
    env) /usr/bin/rustc --version ;;
    *) rustc --version ;;
    esac
}

missing_for_debian_web() {
    /usr/bin/rustc --version 2>/dev/null | grep -qE "^rustc 1\.(9[5-9]|[1-9][0-9][0-9])" || echo rustc-web
    [ -x /usr/bin/cargo ] || echo cargo-web
    [ -d /usr/lib/rustlib/src ] || [ -d /usr/src/rustc-web ] || echo rust-web-src
    command -v wasm-ld >/dev/null || echo lld
}

missing_for_page_tests() {
    command -v chromium >/dev/null || echo chromium
    # Both draw: the page in Chromium, and the program to compare with.
    has_library libvulkan.so.1 || echo libvulkan1
}

# make_page_tests FOLDER: a folder with the modules of tests/web and what they need, and Chromium. Fails, and says why, where they cannot be had.
make_page_tests() {
    npm_folder "$1" tests/web/package.json && (install_missing missing_for_page_tests) || return 1
    cp tests/web/*.mjs "$1"
}
