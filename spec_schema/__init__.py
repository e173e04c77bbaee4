"""From YAML text to checked, frozen data: source, places, diagnostics, models, units, expressions."""
