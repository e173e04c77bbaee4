"""Results as text for people and as records for programs, in the user's units."""
