"""Pages: self-contained HTML from reports and their figures."""
