"""Reads what a run of minamo leaves in its folder, and shows it."""
