"""What is compiled of learning policies."""
