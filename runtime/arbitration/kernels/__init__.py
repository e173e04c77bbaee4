"""What is compiled of arbitration: the competition."""
