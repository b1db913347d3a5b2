"""``python -m motionrt`` is the command ``motionrt``."""

import sys

from motionrt.cli import main

if __name__ == "__main__":
    sys.exit(main())
