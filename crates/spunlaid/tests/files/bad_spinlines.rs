//! Bad files of spinlines and their messages: each file `bad_spinlines/NAME.toml` is rejected, when it is
//! read or when it is solved, with the message in `bad_spinlines/NAME.txt`. With `BLESS=1` in the environment
//! the test writes the messages, to be reviewed.

use crate::messages;
use spunlaid_input::read_spinline;

#[test]
fn rejects_every_bad_spinline_with_its_message() {
    messages::are_as_meant("bad_spinlines", 50, |path| read_spinline(path, &[])?.solve());
}
