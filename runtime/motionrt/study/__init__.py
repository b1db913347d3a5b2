"""Perceptual studies: a page that shows pairs of motions in random order and counts votes, and what votes add up to."""

from motionrt.study.page import write_study
from motionrt.study.pairs import Pair, find_pairs
from motionrt.study.votes import Count, count_votes, wilson

__all__ = ["Count", "Pair", "count_votes", "find_pairs", "wilson", "write_study"]
