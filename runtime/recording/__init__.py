"""What runs leave: what is kept of them while they go on, and the files that hold it."""
