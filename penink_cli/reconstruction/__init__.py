"""The paper's section 2: grey samples and discontinuity edges to an image of any size, and back.

camera       how blurred a photo is
extraction   photo, edges → one clean sample a pixel
reduction    samples → fewer, each of what it can reach; fit → whose reconstruction is the photo
  shrinking    the photo as a coarser camera would see it
thinning     the edges that are worth their bytes
grid         the smallest grid that serves
enlarge      samples, edges → rows of any size
  lattice               output pixels among the samples, and kernels: their taps
  paths.Paths           once: cells, scene (who sees whom), nodes (where paths bend), search (shortest paths)
  separable             every row, as if there were no edge
  render.retouch        again each tile of 8 × 8 pixels that has an edge near:
    tile, nearby_edges  the edges around it
    shade               what hides each sample, and the detour around that (equation 4)
    fades, sums         attenuations, weighted sums (equation 5); lanes: the make for this processor
easing       samples of few levels → the ramps that they were rounded from
soften       the paper's last factor of two
"""
