"""Claims about the topology of a field, judged."""
