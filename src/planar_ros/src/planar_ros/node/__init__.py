"""What a node does besides its work: begin, wait, tell, end; settings; the clock."""
