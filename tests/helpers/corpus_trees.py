"""Small data sets in the layouts in which the large ones are published, made of walks that nobody recorded."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from gaits import gait

from motionrt.formats.smpl import write_npz
from motionrt.motion import Motion

SEQUENCES = (
    "KIT/3/walk_poses", "CMU/01/01_01_poses", "ACCAD/Female1_c3d/A1 - Stand_poses",
    "BioMotionLab_NTroje/rub001/0000_treadmill_norm_poses", "Eyes_Japan_Dataset/hamada/walk-01-hamada_poses",
    "MPI_HDM05/bk/HDM_bk_01_poses", "TotalCapture/s1/walking1_poses", "MPI_Limits/03099/lar1_poses",
    "Transitions_mocap/mazen_c3d/turntwist_poses",
)  # fmt: skip
"""Names of the copy of AMASS with SMPL-H bodies, of every kind of data set that the readers treat apart."""


def walk(number: int, seconds: float = 6.0) -> Motion:
    """A walk of its own speed, at 60 fps, arms hanging and swinging a little."""
    motion, _ = gait(seconds, fps=60.0, speed=0.5 + 0.01 * number)
    rotations = motion.rotations.copy()
    for name, side in (("left_shoulder", -1.0), ("right_shoulder", 1.0)):
        swing = side * (1.3 + 0.1 * np.sin(np.arange(motion.frames) / 9.0 + number))
        joint = motion.skeleton.index(name)
        rotations[:, joint, 0, 0] = rotations[:, joint, 1, 1] = np.cos(swing)
        rotations[:, joint, 1, 0], rotations[:, joint, 0, 1] = np.sin(swing), -np.sin(swing)
    return Motion(rotations, motion.root, motion.fps)


def amass_tree(folder: Path, sequences: Sequence[str] = SEQUENCES, seconds: float = 6.0) -> Path:
    """An AMASS folder with these sequences."""
    for number, name in enumerate(sequences):
        path = folder / f"{name}.npz"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_npz(walk(number, seconds), path)
    return folder


def humanml3d_tree(
    folder: Path, rows: Mapping[str, tuple[str, int, int]], texts: Mapping[str, str], **splits: Sequence[str]
) -> Path:
    """The HumanML3D repository: ``name -> (sequence, first, last frame)``, lines of texts, names of the splits."""
    inner = folder / "HumanML3D"
    (inner / "texts").mkdir(parents=True)
    with (folder / "index.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["source_path", "start_frame", "end_frame", "new_name"])
        for name, (path, first, last) in rows.items():
            writer.writerow([f"./pose_data/{path}.npy", first, last, f"{name}.npy"])
    for name, text in texts.items():
        (inner / "texts" / f"{name}.txt").write_text(text, encoding="utf-8")
    write_splits(inner, **splits)
    return folder


def write_splits(folder: Path, **splits: Sequence[str]) -> None:
    """``train.txt``, ``val.txt`` and ``test.txt``."""
    folder.mkdir(parents=True, exist_ok=True)
    for split in ("train", "val", "test"):
        (folder / f"{split}.txt").write_text("\n".join(splits.get(split, ())), encoding="utf-8")


def write_json(path: Path, content: object) -> Path:
    """JSON, with the folder it lies in."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def babel_label(text: str, start: float | None = None, end: float | None = None, **more: object) -> dict[str, object]:
    """A label of BABEL, of a part of its sequence where there are times."""
    row: dict[str, object] = {"raw_label": text, "proc_label": text, "seg_id": text, "act_cat": [text]}
    return row | ({} if start is None else {"start_t": start, "end_t": end}) | more


def babel_entry(sequence: str, *labels: dict[str, object], seconds: float = 6.0) -> dict[str, object]:
    """A sequence of BABEL with labels of its parts, or of all of it where they have no times."""
    of_parts = bool(labels) and "start_t" in labels[0]
    annotation = {"babel_lid": "x", "labels": list(labels)} if labels else None
    first = sequence.split("/", maxsplit=1)[0]
    return {
        "babel_sid": 1, "url": "", "feat_p": f"{first}/{sequence}.npz", "dur": seconds,
        "seq_ann": None if of_parts else annotation, "frame_ann": annotation if of_parts else None,
    }  # fmt: skip
