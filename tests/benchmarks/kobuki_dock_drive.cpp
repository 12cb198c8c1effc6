// C interface of kobuki::DockDrive, the algorithm of kobuki_auto_docking, for kobuki_dock_drive.py.
#include <kobuki_dock_drive/dock_drive.hpp>

extern "C" {

void* dock_drive_new() { return new kobuki::DockDrive(); }

void dock_drive_delete(void* drive) { delete static_cast<kobuki::DockDrive*>(drive); }

void dock_drive_enable(void* drive) { static_cast<kobuki::DockDrive*>(drive)->enable(); }

// Updates as AutoDockingROS::syncCb does; writes v [m/s] and omega [rad/s], and returns the state.
int dock_drive_update(void* drive, const unsigned char* signals, unsigned char bumper, unsigned char charger,
                      double x, double y, double heading, double* velocity) {
  auto* dock = static_cast<kobuki::DockDrive*>(drive);
  ecl::LegacyPose2D<double> pose;
  pose.x(x);
  pose.y(y);
  pose.heading(heading);
  dock->update(std::vector<unsigned char>(signals, signals + 3), bumper, charger, pose);
  velocity[0] = dock->canRun() ? dock->getVX() : 0.0;
  velocity[1] = dock->canRun() ? dock->getWZ() : 0.0;
  return static_cast<int>(dock->getState());
}
}
