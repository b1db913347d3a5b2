"""A process that does one thing: arguments come as JSON on its command line, the answer goes as JSON to its output."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from typing import Any

from motionrt.errors import MotionRTError


def answered(make: Callable[..., Any], arguments: Sequence[str]) -> int:
    """Print what ``make`` gives for the first argument, an object of its keywords; the exit code."""
    try:
        print(json.dumps(make(**json.loads(arguments[0]))))
    except MotionRTError as error:
        print(error, file=sys.stderr)
        return 1
    return 0
