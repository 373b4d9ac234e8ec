//! Who may talk to the server: programs of this machine that know the token.

use super::not_served;
use spunlaid::ground::Error;
use std::fmt::Write;
use std::io;

/// Where the server is to be reached, and the token that an address must contain.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    port: u16,
    token: String,
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The name of the server in the request is another one, as after an attack on the name service.
    Host,
    /// A page of another origin asks.
    Origin,
    /// The token is wrong or missing.
    Token,
}

impl Refusal {
    /// What is answered.
    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Host => "Use this server only at its address 127.0.0.1.\n",
            Self::Origin => "Pages of other servers may not connect to this one.\n",
            Self::Token => "There is nothing here. Use the whole address that `spunlaid live` has printed.\n",
        }
    }
}

impl Guard {
    /// A guard with a token of 128 random bits of the operating system.
    ///
    /// # Errors
    /// The operating system gives no random numbers.
    pub(super) fn new(port: u16) -> Result<Self, Error> {
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(|error| not_served(io::Error::other(error)))?;
        let token = random.iter().fold(String::new(), |mut text, byte| {
            // Writing to a text cannot fail.
            let _ = write!(text, "{byte:02x}");
            text
        });
        Ok(Self { port, token })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Whether a request may be answered.
    ///
    /// * `path` – of the address; its first part must be the token
    /// * `host`, `origin` – as the headers say; several headers of one name are none
    /// * `needs_origin` – whether the header must be there, as browsers send it with a WebSocket
    ///
    /// # Errors
    /// Why not.
    pub(super) fn check(
        &self,
        path: &str,
        host: Option<&str>,
        origin: Option<&str>,
        needs_origin: bool,
    ) -> Result<(), Refusal> {
        let own = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        let Some(host) = host.filter(|host| own.iter().any(|own| own == host)) else {
            return Err(Refusal::Host);
        };
        match origin {
            Some(origin) if origin.strip_prefix("http://") == Some(host) => {}
            None if !needs_origin => {}
            _ => return Err(Refusal::Origin),
        }
        let token = path.strip_prefix('/').and_then(|rest| rest.split('/').next()).unwrap_or_default();
        if same(token.as_bytes(), self.token.as_bytes()) { Ok(()) } else { Err(Refusal::Token) }
    }
}

/// Whether two texts are equal, in a time that does not depend on where they differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    let differences = a.iter().zip(b).fold(0, |all, (a, b)| all | (a ^ b));
    a.len() == b.len() && std::hint::black_box(differences) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_whole_address_from_this_machine_is_answered() {
        let guard = Guard::new(4000).unwrap();
        let (token, host) = (guard.token.clone(), Some("127.0.0.1:4000"));
        let path = format!("/{token}/live.js");
        let check = |path: &str, host, origin, needs| guard.check(path, host, origin, needs);
        assert_eq!(check(&path, host, None, false), Ok(()));
        assert_eq!(check(&path, Some("localhost:4000"), Some("http://localhost:4000"), true), Ok(()));
        for other in [None, Some("127.0.0.1"), Some("127.0.0.1:4001"), Some("evil.example:4000"), Some("")] {
            assert_eq!(check(&path, other, None, false), Err(Refusal::Host), "{other:?}");
        }
        for other in [
            "null",
            "http://evil.example",
            "https://127.0.0.1:4000",
            "http://127.0.0.1:4000.evil.example",
            "",
        ] {
            assert_eq!(check(&path, host, Some(other), false), Err(Refusal::Origin), "{other}");
        }
        assert_eq!(check(&path, host, None, true), Err(Refusal::Origin));
        for other in
            ["", "/", "//", "/live.js", &path[1..], &path[..20], &format!("/x{path}"), &format!("/{token}0/")]
        {
            assert_eq!(check(other, host, None, false), Err(Refusal::Token), "{other}");
        }
    }

    #[test]
    fn tokens_are_long_and_differ() {
        let [a, b] = [0, 0].map(|port| Guard::new(port).unwrap().token);
        assert!(a.len() == 32 && a != b && a.chars().all(|c| c.is_ascii_hexdigit()));
    }
}
