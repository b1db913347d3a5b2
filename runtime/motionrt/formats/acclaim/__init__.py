"""Acclaim files: `asf` reads the skeleton, `amc` its motion."""
