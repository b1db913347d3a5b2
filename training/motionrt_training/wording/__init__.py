"""Sentences for training: what was measured put into words, and a grammar of things that people do."""
