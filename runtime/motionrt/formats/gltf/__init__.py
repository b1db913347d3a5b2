"""GLB files (binary glTF 2.0): `read` and `write`, and a motion in a character's file (`target`)."""
