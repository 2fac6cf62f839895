// SPDX-License-Identifier: MIT
#ifndef VIEW_CAMERA_H
#define VIEW_CAMERA_H

#include <pass/scene.h>

// The viewer's own camera: flies, or turns around a point. No window, no GPU.
//
// Units: metres, radians, seconds. Yaw 0 looks along -Z and grows to the left; pitch grows upwards
// and stays short of straight up, so that the horizon stays level.
typedef struct view_camera {
    ag_camera lens; // field of view, near plane; its world is made anew
    double eye[3];
    double yaw, pitch;
    double speed; // m/s
    bool orbiting;
    double distance; // to the point that is orbited, > 0
} view_camera;

// Stands where `from` stands and looks where it looks; its roll is dropped. Speed and mode stay.
void view_camera_take(view_camera *c, const ag_camera *from);
ag_camera view_camera_get(const view_camera *c);

// Turns by radians: looks around, or moves around the point.
void view_camera_turn(view_camera *c, double left, double up);
// `keys`: VIEW_MOVE_ bits (view_keys.h), for `seconds`. In orbit the point moves along. Returns
// whether anything moved.
bool view_camera_move(view_camera *c, unsigned keys, double seconds);
// Steps of the wheel: speed, or in orbit the distance, by a tenth each.
void view_camera_wheel(view_camera *c, double steps);
// Starts to turn around the point `distance` metres ahead.
void view_camera_orbit(view_camera *c, double distance);
void view_camera_point(const view_camera *c, double point[3]); // what orbit turns around

// Metres from the middle of `camera` to the nearest triangle of the scene as it stands, alpha
// masks left aside; 0: none.
double view_camera_pick(const ag_scene *scene, const ag_camera *camera);

#endif // VIEW_CAMERA_H
