"""The student of the text tower as the trainer sees it: sentences, and what the large tower says of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor, nn

from motionrt.metrics import retrieval
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.student import TextStudent
from motionrt_training.options import option


@dataclass(frozen=True)
class StudentSettings:
    """Size and losses of the student."""

    words: int = option(256, "directions of the word vectors that are kept")
    d: int = option(256, "width")
    layers: int = option(3, "layers")
    heads: int = option(4, "attention heads")
    ff: int = option(512, "feed-forward width")
    dropout: float = option(0.05, "dropout rate")
    batch: int = option(256, "sentences per batch")
    often: float = option(0.3, "part of a batch that is drawn from the captions of the corpus")
    ranks: float = option(0.2, "weight of ranking known motions as the teacher ranks them")
    sharpness: float = option(0.05, "temperature of those ranks")


@dataclass(frozen=True)
class Lesson:
    """Sentences with what the teacher says: token ids (ragged), unit embeddings (N, 256)."""

    ids: Sequence[NDArray[np.int64]]
    target: NDArray[np.float16]

    def __len__(self) -> int:
        return len(self.ids)

    def chosen(self, rows: Sequence[int]) -> Lesson:
        """Some of the sentences."""
        return Lesson([self.ids[row] for row in rows], self.target[list(rows)])


@dataclass(frozen=True)
class Examination:
    """A split: captions by style, and the unit embeddings (M, 256) of its motions, one caption of a style each."""

    styles: Sequence[Lesson]
    motions: NDArray[np.float32]


class StudentTask:
    """The task of `Trainer`: captions, and sentences of the grammar, by the teacher's embeddings."""

    def __init__(
        self,
        captions: Lesson,
        grammar: Lesson,
        motions: NDArray[np.float32],
        examinations: dict[str, Examination],
        backbone: MiniLM,
        settings: StudentSettings,
        seed: int,
    ) -> None:
        self.parts, self.settings, self.seed, self.examinations = (captions, grammar), settings, seed, examinations
        self.motions = torch.from_numpy(motions)
        torch.manual_seed(seed)
        s = settings
        vocabulary = backbone.words.weight.shape[0]
        self.model = TextStudent(vocabulary, s.words, s.d, s.layers, s.heads, s.ff, motions.shape[1], s.dropout)
        self.model.take_words(backbone)

    def batch(self, step: int) -> dict[str, Tensor]:
        """Token ids (B, T) with mask, target (B, 256)."""
        rng = np.random.default_rng((self.seed, step))
        few = round(self.settings.batch * self.settings.often)
        chosen = [(0, rng.integers(len(self.parts[0]), size=few))]
        chosen += [(1, rng.integers(len(self.parts[1]), size=self.settings.batch - few))]
        ids, mask = tokens([self.parts[part].ids[i] for part, rows in chosen for i in rows])
        target = np.concatenate([self.parts[part].target[rows] for part, rows in chosen])
        return {"ids": ids, "mask": mask, "target": torch.from_numpy(target.astype(np.float32))}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """Distance from the teacher's embedding, and from how it ranks the motions."""
        found, target = F.normalize(model(batch["ids"], batch["mask"]), dim=-1), batch["target"]
        terms = {"distance": 1.0 - (found * target).sum(-1).mean()}
        motions, sharpness = self.motions.to(found.device), self.settings.sharpness
        wanted = (target @ motions.T / sharpness).softmax(-1)
        terms["ranks"] = F.kl_div((found @ motions.T / sharpness).log_softmax(-1), wanted, reduction="batchmean")
        return {"loss": terms["distance"] + self.settings.ranks * terms["ranks"], **terms}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Recalls of student and teacher on each split; `score` is the student's on validation."""
        measures: dict[str, float] = {}
        for split, exam in self.examinations.items():
            cosines, own, teacher = [], [], []
            for style in exam.styles:
                found = embed(cast("TextStudent", model), style.ids)
                target = style.target.astype(np.float32)
                cosines.append((found * target).sum(-1).mean())
                own.append(recalls(found @ exam.motions.T))
                teacher.append(recalls(target @ exam.motions.T))
            measures[f"{split}_cosine"] = float(np.mean(cosines))
            for name, rows in (("", own), ("teacher_", teacher)):
                for k, value in zip(("R1", "R3", "R10"), np.mean(rows, axis=0), strict=True):
                    measures[f"{split}_{name}{k}"] = float(value)
        return {**measures, "score": measures["val_R1"] + measures["val_R3"] + measures["val_R10"]}


def recalls(similarity: NDArray[np.floating]) -> list[float]:
    """R@1, 3, 10 of texts for motions."""
    scores = retrieval(np.asarray(similarity, np.float32)).text_to_motion
    return [scores.recall[k] for k in (1, 3, 10)]


def tokens(ids: Sequence[NDArray[np.int64]]) -> tuple[Tensor, Tensor]:
    """Ragged ids -> (B, T) int64 with zeros behind, mask (B, T) int64."""
    out = np.zeros((len(ids), max(map(len, ids))), dtype=np.int64)
    for row, part in zip(out, ids, strict=True):
        row[: len(part)] = part
    lengths = np.array([len(part) for part in ids])
    mask = (np.arange(out.shape[1])[None] < lengths[:, None]).astype(np.int64)
    return torch.from_numpy(out), torch.from_numpy(mask)


@torch.no_grad()
def embed(model: TextStudent, ids: Sequence[NDArray[np.int64]], chunk: int = 256) -> NDArray[np.float32]:
    """Unit embeddings (N, 256) of ragged token ids."""
    rows = [F.normalize(model(*tokens(ids[i : i + chunk])), dim=-1) for i in range(0, len(ids), chunk)]
    return np.asarray(torch.cat(rows).numpy(), dtype=np.float32)
