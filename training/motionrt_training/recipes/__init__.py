"""One file per shipped model: data, network, losses, schedule."""
