//! What a page of ours may load and run (`Content-Security-Policy`, W3C, *CSP Level 3*).

use sha2::{Digest as _, Sha256};

/// The policy of a page. The page may run its own scripts, scripts of this server, WebAssembly, and
/// workers, including those from URLs that the element created; it may read packages of any server,
/// the still images next to them, and files that the user opens. Other pages may show it in a
/// frame.
pub(crate) fn policy(page: &[u8]) -> String {
    let mut scripts = String::from("'self' 'wasm-unsafe-eval'");
    for script in own_scripts(&String::from_utf8_lossy(page)) {
        scripts += &[" 'sha256-", &base64(&Sha256::digest(script.as_bytes())), "'"].concat();
    }
    format!(
        "default-src 'self'; script-src {scripts}; worker-src 'self' blob:; connect-src * data: blob:; style-src 'self' 'unsafe-inline'; \
         img-src * data: blob:; object-src 'none'; base-uri 'none'; form-action 'none'"
    )
}

/// The inline scripts of a page, as browsers hash them: with one character per line break.
fn own_scripts(page: &str) -> Vec<String> {
    let mut scripts = Vec::new();
    let mut rest = page;
    while let Some((_, begun)) = rest.split_once("<script") {
        let Some((attributes, begun)) = begun.split_once('>') else { break };
        let Some((text, after)) = begun.split_once("</script") else { break };
        if !attributes.contains(" src=") {
            scripts.push(text.replace("\r\n", "\n").replace('\r', "\n"));
        }
        rest = after;
    }
    scripts
}

/// Encodes bytes in Base64 (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let at = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k)) as usize & 63];
            text.push(if k <= three.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
#[path = "policy_tests.rs"]
mod tests;
