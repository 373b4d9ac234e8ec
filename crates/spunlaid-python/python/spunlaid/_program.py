"""The program `spunlaid`, which comes with the package."""

from __future__ import annotations

import signal
import sys

from . import _spunlaid


def main() -> int:
    """Does what the command line asks for; returns the exit code."""
    # Python would remember Ctrl-C until the program has ended. What is ignored stays so, as under `nohup`.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _spunlaid.program(["spunlaid", *sys.argv[1:]])
