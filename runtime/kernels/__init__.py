"""Compiled kernels. They use nothing of ours from outside this folder: its sources key their cache."""
