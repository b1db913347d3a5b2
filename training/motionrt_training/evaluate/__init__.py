"""The papers' protocols, run on torch modules or on exported models through one interface."""
