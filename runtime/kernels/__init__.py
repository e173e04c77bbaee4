"""Compiled kernels. They use no code from outside this folder: its sources key their cache."""
