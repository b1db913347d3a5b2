"""The code behind ``motionrt bench``."""
