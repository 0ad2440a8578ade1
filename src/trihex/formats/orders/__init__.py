"""Orders: who must wait for whom, as files for those who let robots drive."""
