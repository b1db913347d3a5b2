"""Spatial composition: one body moved by several motions at once (SINC 3.1)."""

from motionrt.synthesis.composing.combination import Combination, combination, compatible
from motionrt.synthesis.composing.composition import compose
from motionrt.synthesis.composing.layers import Derive, Layer

__all__ = ["Combination", "Derive", "Layer", "combination", "compatible", "compose"]
