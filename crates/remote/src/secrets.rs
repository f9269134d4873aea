//! Removes user names, passwords and signatures from addresses in any text.

use std::borrow::Cow;

/// The replacement of a secret.
const HIDDEN: char = '…';

/// Schemes of personal addresses, which have no password.
const OF_PEOPLE: [&str; 5] = ["mailto:", "acct:", "sip:", "sips:", "xmpp:"];

/// An address found in a text: the start of its scheme, and the position after the scheme and its
/// slashes.
struct FoundAddress {
    scheme: usize,
    begin: usize,
}

/// Removes what precedes the `@` of an address and what follows its question mark, from any text:
/// targets of redirections, messages of libraries, and typed text with mistakes (`http:/…`).
#[must_use]
pub fn without_secrets(text: &str) -> Cow<'_, str> {
    let mut clean = String::new();
    let mut rest = text;
    while let Some(found) = address_in(rest) {
        let (before, address) = rest.split_at(found.begin);
        hide_without_scheme(before, &mut clean);
        rest = hide(address, &mut clean);
    }
    hide_without_scheme(rest, &mut clean);
    if clean == text { Cow::Borrowed(text) } else { Cow::Owned(clean) }
}

/// Adds a text that may contain `name:password@host` without a scheme, as in libraries' messages
/// about connections.
fn hide_without_scheme(text: &str, clean: &mut String) {
    let is_outside = |c: char| is_end(c) || matches!(c, '(' | ')' | '[' | ']' | ',' | '/' | '\\');
    let mut rest = text;
    while let Some(at) = rest.find('@') {
        let begin = rest[..at].char_indices().rfind(|&(_, c)| is_outside(c));
        let begin = begin.map_or(0, |(at, c)| at + c.len_utf8());
        if has_password(&rest[begin..at]) && begins_with_host(&rest[at + 1..]) {
            clean.push_str(&rest[..begin]);
            clean.push(HIDDEN);
        } else {
            clean.push_str(&rest[..at]);
        }
        clean.push('@');
        rest = &rest[at + 1..];
    }
    clean.push_str(rest);
}

/// Whether a word is a name and a password.
fn has_password(word: &str) -> bool {
    let person = OF_PEOPLE.iter().find_map(|scheme| word.strip_prefix(scheme));
    let Some((name, password)) = person.unwrap_or(word).trim_matches(':').split_once(':') else {
        return false;
    };
    !ends_in_time(name, password)
}

/// Whether a word, split at its first colon, ends in a time, like some file names
/// (`2026-01-01T12:30`).
fn ends_in_time(before: &str, after: &str) -> bool {
    let date = before.trim_end_matches(|c: char| c.is_ascii_digit());
    let hours = before.len() - date.len();
    let is_separated = !date.ends_with(char::is_alphanumeric) || date.ends_with('T');
    let is_pair = |part: &str| part.len() == 2 && is_number(part);
    let whole_seconds = after.trim_end_matches('Z').split('.').next().unwrap_or_default();
    matches!(hours, 1 | 2) && is_separated && whole_seconds.split(':').all(is_pair)
}

/// Whether a text begins with something that can only be a host: it has a dot, a port or a path.
fn begins_with_host(text: &str) -> bool {
    let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-');
    let length = text.find(|c| !is_name(c)).unwrap_or(text.len());
    let (name, after) = text.split_at(length);
    let name = name.trim_end_matches('.');
    let port = after.strip_prefix(':').unwrap_or_default();
    let digits = port.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(port.len());
    let is_port = |port: &str| (1..=5).contains(&port.len()) && is_number(port);
    let is_more = name.contains('.') || after.starts_with('/') || is_port(&port[..digits]);
    text.starts_with('[') || name == "localhost" || (!name.is_empty() && is_more)
}

fn is_number(text: &str) -> bool {
    text.bytes().all(|c| c.is_ascii_digit())
}

/// Whether this character ends an address.
fn is_end(c: char) -> bool {
    c.is_whitespace() || matches!(c, '"' | '\'' | '<' | '>' | '`')
}

/// Whether this character ends user name, password and host.
fn ends_host(c: char) -> bool {
    is_end(c) || matches!(c, '/' | '\\' | '?' | '#')
}

/// The letters and digits before a position in a text.
fn scheme_before(text: &str, at: usize) -> &str {
    text[..at].rsplit(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default()
}

/// The first address in a text, even a mistyped one.
fn address_in(text: &str) -> Option<FoundAddress> {
    let is_slash = |c: char| matches!(c, '/' | '\\');
    let mut from = 0;
    loop {
        let at = from + text[from..].find([':', '/', '\\'])?;
        let run = &text[at..];
        let length = run.find(|c| c != ':' && !is_slash(c)).unwrap_or(run.len());
        let name = scheme_before(text, at);
        let (scheme, begin) = (at - name.len(), at + length);
        let is_web = name.eq_ignore_ascii_case("http") || name.eq_ignore_ascii_case("https");
        let is_address = if run.starts_with(':') {
            // A single letter is a drive of Windows.
            is_web || (name.len() > 1 && run[..length].contains(is_slash))
        } else {
            // Some folders have such names, too.
            let is_word = !text[..scheme].ends_with(['/', '\\', '.', '-', '_', ':', '~']);
            let host = text[begin..].split(ends_host).next().unwrap_or_default();
            is_web && is_word && (length > 1 || host.contains(':'))
        };
        if is_address {
            return Some(FoundAddress { scheme, begin });
        }
        from = begin;
    }
}

/// The first address that begins inside or after another one.
fn further_address_in(text: &str) -> Option<FoundAddress> {
    let mut marks = text.match_indices("://");
    marks.find_map(|(at, mark)| {
        let name = scheme_before(text, at);
        let scheme = at - name.len();
        // After a colon it is part of a password.
        let is_address = name.len() > 1 && !text[..scheme].ends_with(':');
        is_address.then_some(FoundAddress { scheme, begin: at + mark.len() })
    })
}

/// Adds an address from its user name or host on, without secrets, and the addresses inside it.
/// Returns the rest of the text.
fn hide<'a>(text: &'a str, clean: &mut String) -> &'a str {
    let mut rest = text;
    loop {
        let further = further_address_in(rest);
        let own = further.as_ref().map_or(rest, |found| &rest[..found.scheme]);
        let mut from = 0;
        if let Some(at) = secret_in(own) {
            clean.push(HIDDEN);
            from = at;
        }
        let end = from + address_length(&rest[from..]);
        let question = rest[from..end].find('?').map(|at| from + at);
        match further {
            Some(FoundAddress { scheme, begin }) if scheme < question.unwrap_or(end) => {
                clean.push_str(&rest[from..begin]);
                rest = &rest[begin..];
            }
            _ => {
                match question {
                    // The query may be a signature. A sentence can end in a question mark, too.
                    Some(question) if question + 1 < end => {
                        clean.push_str(&rest[from..=question]);
                        clean.push(HIDDEN);
                    }
                    _ => clean.push_str(&rest[from..end]),
                }
                return &rest[end..];
            }
        }
    }
}

/// The length of the address at the beginning of a text.
fn address_length(text: &str) -> usize {
    let end = text.find(is_end).unwrap_or(text.len());
    // In JSON, a backslash before a quotation mark belongs to the quotation mark.
    text[..end].trim_end_matches('\\').len()
}

/// The position of the `@` after user name and password in an address.
fn secret_in(address: &str) -> Option<usize> {
    let host = address.split(ends_host).next().unwrap_or_default();
    if let Some(at) = host.rfind('@') {
        return Some(at);
    }
    if !is_cut(host) {
        return behind_number(address, host);
    }
    // A slash, a blank or a quotation mark in a password should be escaped, but may have been typed
    // unescaped.
    let length = address_length(address);
    address[..length].rfind('@').or_else(|| next_at(address, length))
}

/// Whether a supposed host is a name and the beginning of a password.
fn is_cut(host: &str) -> bool {
    let bare = host.trim_end_matches([',', ';', '.', ':', '!', ')', ']']);
    let port = if host.starts_with('[') { bare.rsplit_once("]:") } else { bare.split_once(':') };
    port.is_some_and(|(_, port)| !is_number(port))
}

/// The position of the `@` after a password of digits and a blank, such as `me:12 34@host`. A host
/// may have such a port, but a word with an `@` is rarely among the next three, and after a host
/// with a dot it is a person's address.
fn behind_number(address: &str, host: &str) -> Option<usize> {
    let (name, port) = host.split_once(':')?;
    let is_host = name.is_empty() || name == "localhost" || name.contains('[');
    if is_host
        || port.is_empty()
        || !is_number(port)
        || !address[host.len()..].starts_with([' ', '\t'])
    {
        return None;
    }
    let at = next_at(address, host.len())?;
    let between = &address[host.len()..at];
    let is_near = between.split_whitespace().count() <= 3;
    (is_near && !(name.contains('.') && is_of_person(between, &address[at + 1..]))).then_some(at)
}

/// Whether the text around an `@` is a person's address, and not the end of a password and a host:
/// the name begins with a letter, the host has a dot and nothing after it, and no quotation that
/// began before the name ends there.
fn is_of_person(before: &str, after: &str) -> bool {
    let name = before.rsplit(is_end).next().unwrap_or_default();
    let is_of_host = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-');
    let (host, behind) = after.split_at(after.find(|c| !is_of_host(c)).unwrap_or(after.len()));
    let closes = |c: char| matches!(c, '"' | '\'' | '`') && !before.contains(c);
    name.starts_with(|c: char| c.is_alphabetic())
        && host.trim_end_matches('.').contains('.')
        && !behind.starts_with(|c| matches!(c, '/' | ':' | '?' | '#' | '\\') || closes(c))
}

/// The position of the `@` before the next host in the same line, and in JSON in the same string.
fn next_at(text: &str, from: usize) -> Option<usize> {
    let line = text[from..].lines().next()?;
    let ends_text = |&(at, _): &(usize, &str)| {
        line[at + 1..].chars().next().is_none_or(|c| matches!(c, ',' | ':' | '}' | ']'))
    };
    let end = line.match_indices('"').find(ends_text).map_or(line.len(), |(at, _)| at);
    let at = line[..end].find('@')?;
    let host = line[at + 1..end].split(ends_host).next().unwrap_or_default();
    let more = host.rfind('@').map_or(0, |at| at + 1);
    host[more..]
        .starts_with(|c: char| c.is_ascii_alphanumeric() || c == '[')
        .then_some(from + at + more)
}

#[cfg(test)]
#[path = "secrets_tests.rs"]
mod tests;
