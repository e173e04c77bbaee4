"""What the pages of a book say: tables and sentences, out of its contents."""
