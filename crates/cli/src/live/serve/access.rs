//! Who may see the picture and end the render: not any page that a browser shows, and from other
//! machines only who knows the token.

use std::net::IpAddr;

use hyper::header::{HOST, HeaderMap, ORIGIN};

/// What a request must have.
pub struct Access {
    /// The hash of the token; hashes are compared in a time that does not depend on them.
    token: Option<blake3::Hash>,
    /// Whether only this machine reaches the server.
    is_local: bool,
}

impl Access {
    /// By the token, if there is one, for a server at an address.
    pub fn new(token: Option<&str>, address: IpAddr) -> Self {
        Self { token: token.map(|token| blake3::hash(token.as_bytes())), is_local: address.is_loopback() }
    }

    /// Why a request is refused, if it is.
    ///
    /// The names of a server that only this machine reaches are those of this machine; with any
    /// other, the page of a stranger has given its own name the address of this machine. The origin
    /// is the page that makes the request, which browsers tell of all but harmless ones.
    pub fn refusal(&self, headers: &HeaderMap, token: Option<&str>) -> Option<&'static str> {
        let mut hosts = headers.get_all(HOST).iter();
        let (Some(host), None) = (hosts.next().and_then(|host| host.to_str().ok()), hosts.next()) else {
            return Some("the request names no host, or several");
        };
        if self.is_local && !is_this_machine(host) {
            return Some("the request is for another host");
        }
        let is_own = |origin: &str| origin.strip_prefix("http://").is_some_and(|origin| origin == host);
        if headers.get_all(ORIGIN).iter().any(|origin| !origin.to_str().is_ok_and(is_own)) {
            return Some("the request is from another page");
        }
        let given = token.map(|token| blake3::hash(token.as_bytes()));
        let is_known = self.token.is_none_or(|token| given == Some(token));
        (!is_known).then_some("the request has no valid token")
    }
}

/// Whether a host, with or without a port, is this machine.
fn is_this_machine(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(address) => address.split(']').next().unwrap_or_default(),
        None => host.split(':').next().unwrap_or_default(),
    };
    name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(|address: IpAddr| address.is_loopback())
}

/// A token that nobody can guess.
pub fn generated_token() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(ORIGIN, origin.parse().unwrap());
        }
        headers
    }

    #[test]
    fn only_names_of_this_machine_are_local() {
        let access = Access::new(None, "127.0.0.1".parse().unwrap());
        for host in ["localhost", "LOCALHOST:80", "127.0.0.1:8642", "127.1.2.3", "[::1]:8642"] {
            assert_eq!(access.refusal(&headers(host, None), None), None, "{host}");
        }
        for host in ["evil.org", "localhost.evil.org", "127.0.0.1.evil.org:8642", "[::2]", "10.0.0.1", ""] {
            assert!(access.refusal(&headers(host, None), None).is_some(), "{host}");
        }
        // The token does not excuse another host.
        let guarded = Access::new(Some("open-sesame"), "127.0.0.1".parse().unwrap());
        assert!(guarded.refusal(&headers("evil.org", None), Some("open-sesame")).is_some());
        assert!(access.refusal(&HeaderMap::new(), None).is_some());
        let mut two = headers("localhost", None);
        two.append(HOST, "evil.org".parse().unwrap());
        assert!(access.refusal(&two, None).is_some());
    }

    #[test]
    fn other_pages_are_refused() {
        let access = Access::new(None, "::1".parse().unwrap());
        let refusal = |origin| access.refusal(&headers("localhost:9000", Some(origin)), None);
        assert_eq!(refusal("http://localhost:9000"), None);
        for origin in ["http://evil.org", "http://localhost:9001", "https://localhost:9000", "null", ""] {
            assert!(refusal(origin).is_some(), "{origin}");
        }
    }

    #[test]
    fn the_token_must_be_right() {
        for address in ["127.0.0.1", "192.0.2.1"] {
            let access = Access::new(Some("open-sesame"), address.parse().unwrap());
            let headers = headers("localhost", None);
            assert_eq!(access.refusal(&headers, Some("open-sesame")), None);
            for token in [None, Some(""), Some("open-sesam"), Some("open-sesame2"), Some("OPEN-SESAME")] {
                assert!(access.refusal(&headers, token).is_some(), "{token:?}");
            }
        }
        let [one, other] = [(); 2].map(|()| generated_token().unwrap());
        assert!(one.len() == 32 && one != other);
    }
}
