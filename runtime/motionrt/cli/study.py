"""``motionrt study``: a page on which people compare motions, and what their votes add up to."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, say
from motionrt.cli.options import add_json, command
from motionrt.cli.parsing import WrongUsageError

HELP = """compare motions by eye: a page that shows pairs in random order and counts votes
A and B are two folders of motion files with the same names (or two files). The page needs no network and shows no
names; everybody saves a file of votes, and 'motionrt study --count *.json' adds them up."""
QUESTION = "Which of the two moves more naturally?"


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "study", run, HELP)
    parser.add_argument("folders", nargs="*", type=Path, metavar="A B", help="two folders, or two motion files")
    parser.add_argument("-o", "--output", type=Path, metavar="OUT", help="page to write (.html), or table (.csv)")
    parser.add_argument("--question", default=QUESTION, metavar="TEXT", help="what is asked (default: %(default)s)")
    parser.add_argument("--count", nargs="+", type=Path, metavar="VOTES", help="add up files of votes (.json) instead")
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the page, or count."""
    if arguments.count:
        if arguments.folders:
            raise WrongUsageError("--count takes files of votes and no folders")
        return _count(arguments)
    if len(arguments.folders) != 2 or arguments.output is None:
        raise WrongUsageError("give two folders and a page, as in: motionrt study ours theirs -o study.html")
    from motionrt.study import find_pairs, write_study

    first, second = arguments.folders
    pairs = find_pairs(first, second)
    path = write_study(pairs, arguments.output, names=_names(first, second), question=arguments.question)
    say(f"{len(pairs)} pairs: open {path} in a browser")
    if arguments.json:
        print_json({"path": str(path), "pairs": [pair.name for pair in pairs]})
    return 0


def _names(first: Path, second: Path) -> tuple[str, str]:
    """What the sides are called: the folders, with their parents where they are called alike."""
    if first.name != second.name:
        return first.name or str(first), second.name or str(second)
    return str(first), str(second)


def _count(arguments: argparse.Namespace) -> int:
    from motionrt.study.votes import count_votes, write_votes

    count = count_votes(arguments.count)
    if arguments.output is not None:
        write_votes(arguments.count, arguments.output)
    if arguments.json:
        print_json(count.as_dict())
        return 0
    print(f"{count.a} was chosen in {count.for_a} of {count.votes} votes of {count.people}: {100 * count.share:.1f} %")
    print(f"95 % interval: {100 * count.low:.1f} to {100 * count.high:.1f} %; {count.b} has the rest")
    return 0
