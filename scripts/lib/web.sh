# Sourced by scripts/web, scripts/test-web, scripts/test-npm and scripts/test-wheel: finds a
# compiler for WebAssembly, and the packages for tests of the page.
# shellcheck shell=bash

WASM=wasm32-unknown-unknown

# Sets `web_cargo` to the command that builds for browsers. It uses rustup's standard library if it
# is installed or can be added, otherwise Debian's compiler for browsers, which builds its own
# standard library from source. Fails with a message if neither is available.
find_web_cargo() {
    if [ -d "$(rustc --print sysroot)/lib/rustlib/$WASM" ] || { command -v rustup >/dev/null && rustup target add "$WASM" >&2; }; then
        web_cargo=(cargo build --locked --target "$WASM")
        return 0
    fi
    if ! (install_missing missing_for_debian_web); then
        say "neither rustup's standard library for $WASM nor Debian's rustc-web can be installed here"
        return 1
    fi
    # Building the standard library is not stable yet; RUSTC_BOOTSTRAP allows it with Debian's
    # compiler.
    web_cargo=(env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=wasm-ld
        /usr/bin/cargo build --locked --target "$WASM" -Zbuild-std=std,panic_abort)
}

# Prints the version of the compiler of `web_cargo`, in one line.
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
    # Both the page in Chromium and the program that it is compared with draw with Vulkan.
    has_library libvulkan.so.1 || echo libvulkan1
}

# make_page_tests FOLDER: creates a folder with the modules of tests/web and their dependencies, and
# installs Chromium. Fails with a message if they cannot be installed.
make_page_tests() {
    npm_folder "$1" tests/web/package.json && (install_missing missing_for_page_tests) || return 1
    cp tests/web/*.mjs "$1"
}
