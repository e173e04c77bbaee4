"""Portraits of behaviors with modes."""
