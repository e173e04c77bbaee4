"""Where trajectories end: traps around what attracts, and the basins of attraction."""
