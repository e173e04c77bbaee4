"""Fixed points and cycles along a control parameter: bifurcation diagrams."""
