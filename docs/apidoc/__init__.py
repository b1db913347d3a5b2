"""What writes the API reference; run ``python docs/make_api.py``."""
