"""The tests. Below are defects that a reader of the code once found, and the tests that fail if they come back.

An edge's strength was that of an unrelated place:
    arrangement/test_detection.py::test_a_new_vertex_has_no_strength_of_an_unrelated_place
    arrangement/test_strengths.py::test_strengths_are_the_steps_of_rendered_scenes
`draw` died on a large busy photo:
    reconstruction/test_grid.py::test_a_grid_may_be_finer_than_the_view_it_is_judged_by
The word PROGRAM in a title became the script:
    selfdrawing/test_page.py::test_a_title_may_be_what_stands_for_it_in_the_page
`draw -v` printed another output than it had written, and standard input as that of three filters:
    illustration/test_drawing.py::test_every_option_of_draw_is_in_the_chain_it_prints
    illustration/test_drawing.py::test_a_photo_from_standard_input_is_a_file_in_the_chain_that_draw_prints
`to-ps --self` ignored options:
    test_main.py::test_to_ps_takes_no_option_that_it_would_ignore
`draw` did not hand on --max-pixels and --threads:
    test_main.py::test_what_is_written_is_limited_as_what_is_read
    test_main.py::test_threads_are_as_many_as_asked_for_everywhere
Want of memory in a kernel was a crash:
    faults/test_shortage.py::test_one_line_and_no_output
    faults/test_shortage.py::test_each_kernel_that_allocates_is_met
An arrangement kept half of an edge for which memory had not sufficed:
    arrangement/test_planar.py::test_want_of_memory_changes_nothing
A missing member and null were told in each other's words:
    formats/test_strokes.py::test_refused
A narrow photo took minutes and gigabytes, a flat one gave no stroke and no word:
    test_main.py::test_a_sheet_is_limited_by_its_area_and_the_refusal_is_quick
    test_main.py::test_a_drawing_too_thin_for_strokes_is_told
"""
