"""What figures and the browser view both draw, as plain arrays: the arm and an explained row."""
