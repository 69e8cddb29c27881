"""Results on disk and the figures derived from them."""
