"""What every answer is checked with: does a tree execute, and is a certificate right?"""
