"""The paper's section 2: grey samples and discontinuity edges to an image of any size, and back."""
