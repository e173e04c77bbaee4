"""What may be otherwise than the spec or the log says, beside its numbers."""
