"""What every command of the training side does with its user's mistakes."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from motionrt.errors import MotionRTError

Given = ParamSpec("Given")
Result = TypeVar("Result")


def reports_errors(main: Callable[Given, Result]) -> Callable[Given, Result]:
    """A command line that ends with one line, ``error: ...``, and exit code 1 where something named is wrong."""

    @functools.wraps(main)
    def run(*args: Given.args, **kwargs: Given.kwargs) -> Result:
        try:
            return main(*args, **kwargs)
        except (MotionRTError, FileNotFoundError) as error:
            sys.exit(f"error: {error}")

    return run
