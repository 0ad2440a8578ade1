"""The figures of Tariq & Kumaravel (2019) with our own configurations, and their misprints put to the test.

`python -m examples.paper` draws all of them into docs/figures; each module draws its own when it is run alone.
"""
