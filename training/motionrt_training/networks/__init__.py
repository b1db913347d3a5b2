"""Networks of motionrt: one small file each."""
