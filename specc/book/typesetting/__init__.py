"""The book as one document: laid out by Typst, from the same chapters as the pages."""
