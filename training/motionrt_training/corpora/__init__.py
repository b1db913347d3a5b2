"""Readers that turn captioned motion data sets into one common :class:`MotionCorpus`."""

from motionrt_training.corpora.corpus import Clip, MotionCorpus

__all__ = ["Clip", "MotionCorpus"]
