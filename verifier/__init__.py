"""The judge: traces read honestly, fidelity measured, topology computed; numbers, no pictures."""
