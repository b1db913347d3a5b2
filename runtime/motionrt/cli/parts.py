"""``motionrt parts``: the body parts that an action needs."""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table
from motionrt.cli.options import add_json, command
from motionrt.cli.parsing import WrongUsageError

if TYPE_CHECKING:
    from motionrt.synthesis.parts import Endpoint, Reason

HELP = """say which body parts an action needs, and why
The parts are left arm, right arm, left leg, right leg, torso and global (the way and direction of the whole body).
Rules find them, offline; with --endpoint and --llm a language model of yours does."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "parts", run, HELP)
    parser.add_argument("text", metavar="TEXT", help="what somebody does, as in 'kick with the right leg'")
    parser.add_argument("--endpoint", metavar="URL", help="an OpenAI-compatible server, as in http://localhost:8000/v1")
    parser.add_argument("--llm", metavar="NAME", help="the model to ask there")
    parser.add_argument("--key-variable", metavar="NAME", help="environment variable that holds the server's API key")
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the parts with what they come from."""
    from motionrt.motion.body_parts import PARTS
    from motionrt.synthesis.parts import RulesLabeller, body_parts

    endpoint = _endpoint(arguments)
    labeller = "rules" if endpoint is None else "llm"
    found = body_parts(arguments.text, labeller=labeller, endpoint=endpoint)
    reasons = RulesLabeller().explain(arguments.text) if endpoint is None else ()
    parts = [part for part in PARTS if part in found]
    if arguments.json:
        because = [_reason_json(reason, PARTS) for reason in reasons]
        print_json({"text": arguments.text, "labeller": labeller, "parts": parts, "because": because})
        return 0
    print(", ".join(parts) or "none")
    if reasons:
        print()
        print_table(["words", "parts", "rule"], [_cells(reason, PARTS) for reason in reasons], "<<<")
    return 0


def _endpoint(arguments: argparse.Namespace) -> Endpoint | None:
    """The server that the arguments name, if any."""
    from motionrt.errors import InvalidInputError
    from motionrt.synthesis.parts import Endpoint

    if arguments.endpoint is None and arguments.llm is None:
        return None
    if arguments.endpoint is None or arguments.llm is None:
        raise WrongUsageError("a language model needs both --endpoint URL and --llm NAME")
    key = None if arguments.key_variable is None else os.environ.get(arguments.key_variable)
    if arguments.key_variable is not None and not key:
        raise InvalidInputError(f"the environment variable {arguments.key_variable} is not set")
    return Endpoint(arguments.endpoint, arguments.llm, api_key=key)


def _reason_json(reason: Reason, order: tuple[str, ...]) -> dict[str, object]:
    parts = [part for part in order if part in reason.parts]
    return {"words": reason.words, "rule": reason.rule, "parts": parts, "adds": reason.adds}


def _cells(reason: Reason, order: tuple[str, ...]) -> list[str]:
    parts = ", ".join(part for part in order if part in reason.parts)
    return [reason.words, parts if reason.adds else f"not {parts}", reason.rule]
