"""BVH files: `read` and `write`, and a motion in the hierarchy of a file that exists (`target`)."""
