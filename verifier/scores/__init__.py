"""Scores of similarity, printed beside the verdict for comparison only."""
