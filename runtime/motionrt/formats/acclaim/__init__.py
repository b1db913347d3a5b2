"""Acclaim files: a skeleton (ASF) and its motion (AMC), read."""

from motionrt.formats.acclaim.amc import read_amc
from motionrt.formats.acclaim.asf import read_asf

__all__ = ["read_amc", "read_asf"]
