"""The topology of the robot, found in its trace, beside that of its spec."""
