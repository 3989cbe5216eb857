"""docs/python.md, as it stands there, against a daemon."""

import doctest
import re
import sys
import unittest

from appliance import SOURCE, Appliance

sys.path[:0] = [str(SOURCE / "clients/python/src")]

DEFAULT_ADDRESS = "127.0.0.1:7402"


class PythonDocsTest(unittest.TestCase):
    def test_what_stands_there_is_so(self):
        page = (SOURCE / "docs/python.md").read_text()
        with Appliance() as appliance:
            text = re.sub(r"^```.*$", "", page, flags=re.M).replace(DEFAULT_ADDRESS, f"127.0.0.1:{appliance.port}")
            test = doctest.DocTestParser().get_doctest(text, {}, "docs/python.md", None, 0)
            test.globs["pull_the_plug"] = lambda: test.globs["client"]._connection._socket.shutdown(2)
            told = []
            runner = doctest.DocTestRunner(optionflags=doctest.FAIL_FAST)
            runner.run(test, out=told.append, clear_globs=False)
            if "client" in test.globs:
                test.globs["client"].close()
        self.assertGreater(len(test.examples), 40)
        self.assertEqual(runner.failures, 0, "".join(told))


if __name__ == "__main__":
    unittest.main()
