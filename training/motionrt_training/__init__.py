"""Training of the models that motionrt runs (needs torch; the runtime never imports this)."""
