"""Draws runs for print: strips of particles, histories, movies."""
