"""Every corpus by its name, and a report of what is there.

    python -m motionrt_training.corpora.reading humanml3d HumanML3D --amass AMASS
    python -m motionrt_training.corpora.reading babel babel_v1.0_release --amass AMASS --json

Nothing is packed; the same report is printed where a corpus is packed.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError
from motionrt_training.command import reports_errors
from motionrt_training.corpora.amass import read_amass
from motionrt_training.corpora.babel import SPELLINGS, read_babel
from motionrt_training.corpora.babel_pairs import read_babel_pairs
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.corpus import MotionCorpus
from motionrt_training.corpora.humanml3d import read_humanml3d
from motionrt_training.corpora.kitml import read_kitml

Reader = Callable[[argparse.Namespace], MotionCorpus]

READERS: dict[str, Reader] = {
    "amass": lambda args: read_amass(args.folder),
    "babel": lambda args: read_babel(args.folder, args.amass, spelling=args.labels or "raw", whole=args.whole),
    "babel_pairs": lambda args: read_babel_pairs(
        args.folder, args.amass, spelling=args.labels or "proc", every=args.every
    ),
    "cmu": lambda args: read_cmu(args.folder),
    "humanml3d": lambda args: read_humanml3d(args.folder, args.amass),
    "kitml": lambda args: read_kitml(args.folder, args.amass),
}
"""Corpora of annotated clips; the project's own recordings are read by :mod:`motionrt_training.corpora.mocap`."""

ALONE = ("amass", "cmu")
"""Those that need no AMASS folder beside their own."""


def add_options(parser: argparse.ArgumentParser, *others: str) -> None:
    """The corpus, its folders, and how it is to be read; ``others`` are further names."""
    parser.add_argument("corpus", choices=[*others, *READERS], help="which data set it is")
    parser.add_argument("folder", help="its folder of annotations (for amass, cmu and mocap: of motions)")
    parser.add_argument("--amass", help="the AMASS folder that kitml, humanml3d and babel annotate")
    parser.add_argument("--labels", choices=SPELLINGS, help="babel: labels as typed (raw) or spelt alike (proc)")
    parser.add_argument("--whole", action="store_true", help="babel: labels of whole sequences, too")
    parser.add_argument("--licence", help="terms of the data, for the record that models carry (default: not stated)")
    parser.add_argument("--origin", help="who published the data, for that record (default: not stated)")
    parser.add_argument("--every", action="store_true", help="babel_pairs: keep 'stand' and pairs seen in training")


def read_named(args: argparse.Namespace) -> MotionCorpus:
    """The corpus that the options name.

    Raises:
        InvalidInputError: it annotates AMASS, and no AMASS folder is named.
        MotionFileNotFoundError: no such folder, or it is not that data set.
        FormatError: a damaged annotation.
    """
    if args.corpus not in ALONE and args.amass is None:
        raise InvalidInputError(f"{args.corpus} annotates AMASS sequences: name their folder with --amass")
    if not Path(args.folder).is_dir():
        raise MotionFileNotFoundError(f"{args.folder} is no folder; name the folder of {args.corpus}")
    return READERS[args.corpus](args)


def read_corpus(name: str, folder: str, amass: str | None = None) -> MotionCorpus:
    """The corpus called ``name``, read as its options are by default."""
    if name not in READERS:
        raise InvalidInputError(f"no corpus reader '{name}'; there are: {', '.join(READERS)}")
    return read_named(
        argparse.Namespace(corpus=name, folder=folder, amass=amass, labels=None, whole=False, every=False)
    )


@reports_errors
def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Say what of a data set is there, missing, and left out.")
    add_options(parser)
    parser.add_argument("--json", action="store_true", help="as JSON, with every name")
    args = parser.parse_args()
    report = read_named(args).report
    if report is None:
        raise InvalidInputError(f"the reader of {args.corpus} makes no report; pack it")
    print(json.dumps(report.as_dict(), indent=1) if args.json else report)


if __name__ == "__main__":
    main()
