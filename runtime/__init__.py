"""The machine: the program format, interpolated fields, their kernels, integrators, recordings."""
