"""The reference of what extensions use; tools/reference calls it."""
