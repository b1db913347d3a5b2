"""From trained torch modules to proven ONNX files: `python -m motionrt_export all`."""
