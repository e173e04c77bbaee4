"""From YAML text to checked data: source, places, diagnostics, models, units, expressions."""
