"""``motionrt parts``: the body parts that an action needs."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, print_table, say
from motionrt.cli.options import add_json, command
from motionrt.cli.parsing import WrongUsageError

if TYPE_CHECKING:
    from motionrt.synthesis.parts import Endpoint, Reason

HELP = """say which body parts an action needs, and why
The parts are left arm, right arm, left leg, right leg, torso and global (the way and direction of the whole body).
Rules find them, offline; with --endpoint and --llm a language model of yours does.
With --file a whole list of texts is labelled into a file, one JSON object a line."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "parts", run, HELP)
    parser.add_argument("text", metavar="TEXT", nargs="?", help="what somebody does, as in 'kick with the right leg'")
    parser.add_argument("--file", type=Path, metavar="FILE", help="a text file with one action a line, instead of TEXT")
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="where the parts of --file go (.jsonl)")
    parser.add_argument("--endpoint", metavar="URL", help="an OpenAI-compatible server, as in http://localhost:8000/v1")
    parser.add_argument("--llm", metavar="NAME", help="the model to ask there")
    parser.add_argument("--key-variable", metavar="NAME", help="environment variable that holds the server's API key")
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the parts with what they come from, or label a file."""
    from motionrt.errors import InvalidInputError

    if (arguments.text is None) == (arguments.file is None) or (arguments.file is None) != (arguments.out is None):
        raise InvalidInputError("give one TEXT, or --file LABELS with -o PARTS.jsonl")
    return _label_one(arguments) if arguments.file is None else _label_file(arguments)


def _label_file(arguments: argparse.Namespace) -> int:
    """Write a line for every text of the file, in its order; texts that cannot be labelled have no parts and a why."""
    from motionrt.formats.atomic import write_bytes
    from motionrt.retrieval.captions import read_captions

    texts, endpoint, progress = read_captions(arguments.file), _endpoint(arguments), Progress()
    rows = []
    for done, text in enumerate(texts, start=1):
        rows.append(_labelled(text, endpoint))
        progress(done, len(texts), text)
    lines = "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in rows)
    write_bytes(arguments.out, lines.encode("utf-8"))
    failed = sum("error" in row for row in rows)
    say(f"{arguments.out}: {len(rows)} texts" + (f", {failed} of them could not be labelled" if failed else ""))
    return 0


def _labelled(text: str, endpoint: Endpoint | None) -> dict[str, object]:
    from motionrt.errors import InvalidInputError, LabellingError
    from motionrt.synthesis.parts import body_parts

    labeller = "rules" if endpoint is None else "llm"
    try:
        return {
            "text": text,
            "labeller": labeller,
            "parts": _ordered(body_parts(text, labeller=labeller, endpoint=endpoint)),
        }
    except (InvalidInputError, LabellingError) as error:
        return {"text": text, "labeller": labeller, "parts": [], "error": str(error)}


def _ordered(found: Iterable[str]) -> list[str]:
    from motionrt.motion.body_parts import PARTS

    wanted = set(found)
    return [part for part in PARTS if part in wanted]


def _label_one(arguments: argparse.Namespace) -> int:
    from motionrt.motion.body_parts import PARTS
    from motionrt.synthesis.parts import RulesLabeller, body_parts

    endpoint = _endpoint(arguments)
    labeller = "rules" if endpoint is None else "llm"
    found = body_parts(arguments.text, labeller=labeller, endpoint=endpoint)
    reasons = RulesLabeller().explain(arguments.text) if endpoint is None else ()
    parts = _ordered(found)
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
