"""What a verification found, as text and as JSON."""
