//! Texts in which addresses stand, whoever wrote them, without user names, passwords and signatures.

use std::borrow::Cow;

/// What stands in place of a secret.
const HIDDEN: char = '…';

/// Schemes of addresses of people, which have no password.
const OF_PEOPLE: [&str; 5] = ["mailto:", "acct:", "sip:", "sips:", "xmpp:"];

/// Where an address stands in a text: where its scheme begins, and where it goes on behind the scheme and its slashes.
struct Found {
    scheme: usize,
    begin: usize,
}

/// A text without what stands before the `@` of an address, or behind its question mark: what a server redirects to, what a library says, what
/// a person has typed and mistyped (`http:/…`).
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

/// Adds a text in which `name:password@host` may stand without a scheme, as libraries tell of connections.
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

/// Whether a word, parted at its first colon, ends in a time, as names of files do (`2026-01-01T12:30`).
fn ends_in_time(before: &str, after: &str) -> bool {
    let date = before.trim_end_matches(|c: char| c.is_ascii_digit());
    let hours = before.len() - date.len();
    let is_separated = !date.ends_with(char::is_alphanumeric) || date.ends_with('T');
    let is_pair = |part: &str| part.len() == 2 && is_number(part);
    let whole_seconds = after.trim_end_matches('Z').split('.').next().unwrap_or_default();
    matches!(hours, 1 | 2) && is_separated && whole_seconds.split(':').all(is_pair)
}

/// Whether a text begins with what can only be a host: it has a dot, a port or a path.
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

/// Whether an address ends before this.
fn is_end(c: char) -> bool {
    c.is_whitespace() || matches!(c, '"' | '\'' | '<' | '>' | '`')
}

/// Whether user name, password and host end before this.
fn ends_host(c: char) -> bool {
    is_end(c) || matches!(c, '/' | '\\' | '?' | '#')
}

/// The letters and digits before a place in a text.
fn scheme_before(text: &str, at: usize) -> &str {
    text[..at].rsplit(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default()
}

/// The first address in a text, also a mistyped one.
fn address_in(text: &str) -> Option<Found> {
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
            // A drive of Windows is one letter.
            is_web || (name.len() > 1 && run[..length].contains(is_slash))
        } else {
            // Folders are called so, too.
            let is_word = !text[..scheme].ends_with(['/', '\\', '.', '-', '_', ':', '~']);
            let host = text[begin..].split(ends_host).next().unwrap_or_default();
            is_web && is_word && (length > 1 || host.contains(':'))
        };
        if is_address {
            return Some(Found { scheme, begin });
        }
        from = begin;
    }
}

/// The first address that begins in an address or behind it.
fn further_address_in(text: &str) -> Option<Found> {
    let mut marks = text.match_indices("://");
    marks.find_map(|(at, mark)| {
        let name = scheme_before(text, at);
        let scheme = at - name.len();
        // Behind a colon it is part of a password.
        let is_address = name.len() > 1 && !text[..scheme].ends_with(':');
        is_address.then_some(Found { scheme, begin: at + mark.len() })
    })
}

/// Adds an address, from its user name or host on, without secrets, and those that stand in it; the answer is what follows.
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
            Some(Found { scheme, begin }) if scheme < question.unwrap_or(end) => {
                clean.push_str(&rest[from..begin]);
                rest = &rest[begin..];
            }
            _ => {
                match question {
                    // That may be a signature. A sentence can end in a question mark, too.
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

/// How long an address is that a text begins with.
fn address_length(text: &str) -> usize {
    let end = text.find(is_end).unwrap_or(text.len());
    // In JSON a backslash before a quotation mark belongs to that.
    text[..end].trim_end_matches('\\').len()
}

/// Where in an address the `@` is behind user name and password.
fn secret_in(address: &str) -> Option<usize> {
    let host = address.split(ends_host).next().unwrap_or_default();
    if let Some(at) = host.rfind('@') {
        return Some(at);
    }
    if !is_cut(host) {
        return behind_number(address, host);
    }
    // A password with a slash, a blank or a quotation mark in it would have to be written otherwise, but may have been typed so.
    let length = address_length(address);
    address[..length].rfind('@').or_else(|| next_at(address, length))
}

/// Whether what should be a host is a name and the begin of a password.
fn is_cut(host: &str) -> bool {
    let bare = host.trim_end_matches([',', ';', '.', ':', '!', ')', ']']);
    let port = if host.starts_with('[') { bare.rsplit_once("]:") } else { bare.split_once(':') };
    port.is_some_and(|(_, port)| !is_number(port))
}

/// The `@` behind a password of digits and a blank, such as `me:12 34@host`. A host may have such a port, but seldom is a word with an `@` among
/// the next three, and of a host with a dot it is a person's address then.
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

/// Whether what stands around an `@` is a person's address and no end of a password and a host: its name begins with a letter, the host has a
/// dot and nothing behind it, and no quotation mark that was set before the name ends there.
fn is_of_person(before: &str, after: &str) -> bool {
    let name = before.rsplit(is_end).next().unwrap_or_default();
    let is_of_host = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-');
    let (host, behind) = after.split_at(after.find(|c| !is_of_host(c)).unwrap_or(after.len()));
    let closes = |c: char| matches!(c, '"' | '\'' | '`') && !before.contains(c);
    name.starts_with(|c: char| c.is_alphabetic())
        && host.trim_end_matches('.').contains('.')
        && !behind.starts_with(|c| matches!(c, '/' | ':' | '?' | '#' | '\\') || closes(c))
}

/// The `@` before the next host in the same line, and in JSON in the same text.
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
