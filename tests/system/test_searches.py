"""A client's SQL: quick where it is sound, ended where it is not, and nobody else's business."""

import unittest

from appliance import Appliance
from client import Refused

SOUND = "SELECT * FROM DeviceDrivers WHERE Type = 'Mill' AND NumberOfJoints = 5"
MANY = ", ".join(f"DeviceDrivers t{i}" for i in range(20))
HOSTILE = f"SELECT a.MechanismID FROM DeviceDrivers a, {MANY} WHERE a.Length + t19.Length < 0"


def grown(text, times):
    """A table whose column n is the text, doubled so many times."""
    table = f"(SELECT MechanismID, '{text}' n FROM DeviceDrivers WHERE MechanismID <= 9 LIMIT 9)"
    for _ in range(times):
        table = f"(SELECT MechanismID, n||n n FROM {table} LIMIT 9)"
    return table


# The database counts each trim as one instruction; with texts of 64 KB one takes seconds.
LONG_TEXTS = f"SELECT x.MechanismID FROM {grown('a' * 127, 9)} x, {grown('b' * 80, 6)} y WHERE trim(x.n, y.n||'a')='q'"


class Searches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())

    def searcher(self):
        client = self.appliance.client("searcher")
        client.call("DeviceDriverManager.OpenDeviceDriverDatabase")
        return client

    def test_statements_that_would_take_long_are_refused(self):
        client = self.searcher()
        for sql in (HOSTILE, LONG_TEXTS):
            with self.subTest(sql=sql[:60]), self.assertRaises(Refused) as refused:
                client.call("DeviceDriverManager.SearchDatabaseRecordSet", MachineSQLStatement=sql)
            # By what it does, or, where a busy computer gives it no turn, by the time that is over.
            self.assertRegex(refused.exception.message, "the SQL statement was refused|did not end within")
        self.assertGreater(client.call("DeviceDriverManager.SearchDatabaseRecordSet", MachineSQLStatement=SOUND), 0)

    def test_many_of_them_hold_up_neither_other_clients_nor_the_end(self):
        with Appliance() as appliance:
            for _ in range(20):
                client = appliance.client("hostile")
                client.call("DeviceDriverManager.OpenDeviceDriverDatabase")
                request = ('{"jsonrpc":"2.0","id":9,"method":"DeviceDriverManager.SearchDatabaseRecordSet",'
                           f'"params":["{HOSTILE}"]}}\n')
                client.send_bytes(request.encode() * 100)
            # 2000 searches of 200 ms wait by now; the machine is loaded, moved and stopped all the same.
            operator = appliance.operator()
            self.assertEqual(operator.state()["mechanism"], "DMACXYZ")
            self.assertTrue(operator.call("RMAC_CAM.StopNow"))
            self.assertEqual(appliance.end(), 0)


if __name__ == "__main__":
    unittest.main()
