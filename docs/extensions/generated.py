"""Parts of pages that are made from the code: each function returns Markdown."""
