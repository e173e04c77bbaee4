"""The machine: the program format, interpolated fields and their kernels, integrators, recordings."""
