"""`python -m spunlaid` is the program `spunlaid`."""

import sys

from ._program import main

sys.exit(main())
