"""Check files of ``new_joint_vecs`` against this project's ``guo263``.

    python -m motionrt_training.corpora.check_features HumanML3D/new_joint_vecs/012314.npy ...

For each file: how well the recovered joints follow the velocities that the file states, how far its bones are from the
published skeleton, and the largest difference of every group of features.
"""

from __future__ import annotations

import argparse

from motionrt.errors import InvalidInputError
from motionrt.motion.features import guo_file


def report(name: str, found: guo_file.FileCheck) -> str:
    """Some lines for people."""
    groups = "\n".join(f"  {group:16} {apart:.1e}" for group, apart in found.features.items())
    signs = f"  rows whose yaw step has the wrong sign: {list(found.wrong_signs)}\n" if found.wrong_signs else ""
    return (
        f"{name}: {'agrees' if found.agrees else 'DIFFERS'}\n  joints recovered {found.recovered:.1e} m\n"
        f"  bone lengths     {found.bone_lengths:.1e} m\n{signs}{groups}"
    )


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Check files of new_joint_vecs against guo263.")
    parser.add_argument("files", nargs="+", help=".npy files of shape (frames, 263)")
    for name in parser.parse_args().files:
        try:
            print(report(name, guo_file.check(guo_file.load(name))))
        except InvalidInputError as error:
            print(error)


if __name__ == "__main__":
    main()
