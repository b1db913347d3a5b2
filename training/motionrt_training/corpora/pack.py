"""The packed corpus: features of every clip, computed once into one ``.npz``.

Arrays: ``features`` ``(frames of all clips, 263)`` float16, ``start`` and ``length`` ``(clips,)`` int64 into them, and
``meta``, a JSON list with ``id``, ``split``, ``texts`` and ``texts_mirror`` (what is said of the mirror image) of each.

    python -m motionrt_training.corpora.pack cmu ../shared/data/mocap/cmu -o runs/cmu.npz
    python -m motionrt_training.corpora.pack humanml3d HumanML3D --amass AMASS -o runs/humanml3d.npz
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from tqdm import tqdm

from motionrt.errors import InvalidInputError
from motionrt.motion.features import guo263
from motionrt_training.corpora.babel import read_babel
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.humanml3d import read_humanml3d
from motionrt_training.corpora.kitml import read_kitml
from motionrt_training.corpora.text_mirror import mirror_text

AMASS_READERS: dict[str, Callable[[str, str], MotionCorpus]] = {
    "babel": read_babel,
    "humanml3d": read_humanml3d,
    "kitml": read_kitml,
}


def read_corpus(name: str, folder: str, amass: str | None = None) -> MotionCorpus:
    """The corpus called ``name`` (cmu, kitml, humanml3d, babel); all but cmu annotate an AMASS folder."""
    if name == "cmu":
        return read_cmu(folder)
    if name not in AMASS_READERS:
        raise InvalidInputError(f"no corpus reader '{name}'; there are: cmu, {', '.join(sorted(AMASS_READERS))}")
    if amass is None:
        raise InvalidInputError(f"{name} annotates AMASS sequences: name their folder with --amass")
    return AMASS_READERS[name](folder, amass)


def pack(corpus: MotionCorpus, path: str | Path) -> Path:
    """Write the ``guo263`` features and texts of ``corpus`` to ``path``; returns it."""
    clips = tqdm(corpus.motions(), total=len(corpus), desc=f"packing {corpus.name}", unit="clip")
    features = [guo263.encode(motion.resample(guo263.FPS)).astype(np.float16) for _, motion in clips]
    lengths = np.array([len(rows) for rows in features])
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(
        target,
        features=np.concatenate(features),
        start=np.cumsum(lengths) - lengths,
        length=lengths,
        meta=json.dumps([_meta(clip) for clip in corpus.clips], ensure_ascii=False),
    )
    return target


def _meta(clip: Clip) -> dict[str, object]:
    texts = _texts(clip)
    return {"id": clip.id, "split": clip.split, "texts": texts, "texts_mirror": [mirror_text(text) for text in texts]}


def _texts(clip: Clip) -> list[str]:
    """The clip's captions; to train on, also its action labels as one more."""
    joined = " and ".join(clip.labels)
    extra = [joined] if clip.split == "train" and joined and joined not in clip.texts else []
    return [*clip.texts, *extra]


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Compute the features of a captioned corpus once.")
    parser.add_argument("corpus", choices=["cmu", *sorted(AMASS_READERS)])
    parser.add_argument("folder", help="the data set's folder of annotations (and, for cmu, motions)")
    parser.add_argument("--amass", help="the AMASS folder that kitml, humanml3d and babel annotate")
    parser.add_argument("-o", "--out", required=True, help="the .npz to write")
    args = parser.parse_args()
    pack(read_corpus(args.corpus, args.folder, args.amass), args.out)


if __name__ == "__main__":
    main()
