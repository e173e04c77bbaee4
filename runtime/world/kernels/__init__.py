"""Compiled loops of the senses: rays, shadows and lines of sight."""
