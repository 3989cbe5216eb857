"""Written by clients/python/generate.py from rpc.discover; do not edit."""

QUEUEING = frozenset(
    {
        "Device.Machine_MoveInArc",
        "Device.Machine_MoveInArc3",
        "Device.Machine_MoveInLine",
        "Device.Machine_MoveInNurbs",
        "Device.Machine_MoveInNurbsND",
        "RMAC_CAM.AutoMeasure",
        "RMAC_CAM.AwaitInput",
        "RMAC_CAM.DoToolChange",
        "RMAC_CAM.Dwell",
        "RMAC_CAM.InTurn",
        "RMAC_CAM.MoveAllAxis",
        "RMAC_CAM.MoveAlongArc",
        "RMAC_CAM.MoveAlongArc3",
        "RMAC_CAM.MoveAlongLine",
        "RMAC_CAM.MoveAlongNurbs",
        "RMAC_CAM.MoveAlongNurbsND",
        "RMAC_CAM.MoveInArc",
        "RMAC_CAM.MoveRotaryAxis",
        "RMAC_CAM.MoveToJointTarget",
        "RMAC_CAM.MoveToPathTarget",
        "RMAC_CAM.MoveToXYZ",
        "RMAC_CAM.ProgramStop",
    }
)
