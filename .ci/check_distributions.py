"""Check what the built distributions hold: python .ci/check_distributions.py SDIST WHEEL WHEEL_BUILT_FROM_THE_SDIST

The wheel holds motionrt alone, the sdist no checkpoint, either has less than 100 MB, and a wheel built from the sdist
is the wheel built from the checkout, file for file. Prints what is wrong, a line each; the exit code is then 1.
"""

from __future__ import annotations

import sys
import tarfile
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

LIMIT = 100_000_000  # bytes, of either: what package indexes take
CHECKPOINTS = (".safetensors", ".pt", ".ckpt")
GALLERY = "motionrt/_assets/starter/"  # its columns are .safetensors, too


def main(argv: Sequence[str]) -> int:
    if len(argv) != 3:
        sys.exit(__doc__)
    sdist, wheel, rebuilt = map(Path, argv)
    problems = [*wheel_problems(wheel), *sdist_problems(sdist), *differences(wheel, rebuilt)]
    print(
        "\n".join(problems)
        or f"{sdist.name} ({sdist.stat().st_size / 1e6:.0f} MB) and {wheel.name} hold what they should"
    )
    return 1 if problems else 0


def wheel_problems(wheel: Path) -> Iterator[str]:
    """What of a wheel is neither motionrt nor about it, or is missing; its size."""
    yield from too_large(wheel)
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    tops = {name.split("/")[0] for name in names}
    yield from (f"{wheel.name} holds {top}" for top in sorted(tops) if top != "motionrt" and ".dist-info" not in top)
    for wanted in (
        "motionrt/py.typed",
        "motionrt/_assets/models_manifest.yaml",
        "motionrt/_assets/models/tokenizer.json",
    ):
        if wanted not in names:
            yield f"{wheel.name} lacks {wanted}"
    yield from (f"{wheel.name} holds {name}" for name in names if name.endswith(CHECKPOINTS) and GALLERY not in name)


def sdist_problems(sdist: Path) -> Iterator[str]:
    """What of a source distribution should not be in it; its size."""
    yield from too_large(sdist)
    with tarfile.open(sdist) as archive:
        names = [member.name.split("/", 1)[-1] for member in archive.getmembers()]
    yield from (f"{sdist.name} holds {name}" for name in names if name.endswith(CHECKPOINTS) and GALLERY not in name)
    yield from (f"{sdist.name} holds {name}" for name in names if name.startswith(("runs/", "build/", ".ci/")))
    yield from (
        f"{sdist.name} lacks {name}" for name in ("pyproject.toml", "runtime/motionrt/__init__.py") if name not in names
    )


def too_large(file: Path) -> Iterator[str]:
    """Whether a distribution is larger than an index takes."""
    size = file.stat().st_size
    if size > LIMIT:
        yield f"{file.name} has {size / 1e6:.0f} MB, more than {LIMIT / 1e6:.0f}"


def differences(wheel: Path, rebuilt: Path) -> Iterator[str]:
    """Files that two wheels do not have in common, byte for byte."""
    ours, theirs = contents(wheel), contents(rebuilt)
    for name in sorted(ours.keys() | theirs.keys()):
        if ours.get(name) != theirs.get(name):
            kind = "differs" if name in ours and name in theirs else "is only there" if name in theirs else "is missing"
            yield f"in the wheel built from the sdist, {name} {kind}"


def contents(wheel: Path) -> dict[str, bytes]:
    """The files of a wheel by name."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
