// SPDX-License-Identifier: MIT
// The C face of GLM: pass/math.h. Nothing here allocates or throws.
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <pass/math.h>

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

static void store(const glm::dmat4 &m, double out[16]) noexcept
{
    const double *p = glm::value_ptr(m);
    for (int i = 0; i < 16; i++)
        out[i] = p[i];
}

static void store(const glm::dvec3 &v, double out[3]) noexcept
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

static bool finite16(const double m[16]) noexcept
{
    for (int i = 0; i < 16; i++)
        if (!std::isfinite(m[i]))
            return false;
    return true;
}

// A unit vector along `v`, or `otherwise` where there is no direction in it.
static glm::dvec3 direction(const glm::dvec3 &v, const glm::dvec3 &otherwise) noexcept
{
    // By the largest component first: neither tiny nor huge vectors leave the range.
    double largest = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
    if (!(largest > 0) || !std::isfinite(largest))
        return otherwise;
    return glm::normalize(v / largest);
}

static glm::dvec3 perpendicular(const glm::dvec3 &v) noexcept
{
    return std::fabs(v.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
}

void ag_mat_identity(double out[16])
{
    store(glm::dmat4(1.0), out);
}

void ag_mat_mul(const double a[16], const double b[16], double out[16])
{
    store(glm::make_mat4(a) * glm::make_mat4(b), out);
}

bool ag_mat_inverse(const double m[16], double out[16])
{
    store(glm::inverse(glm::make_mat4(m)), out);
    if (finite16(out))
        return true;
    ag_mat_identity(out);
    return false;
}

void ag_mat_from_trs(const double translation[3], const double rotation[4], const double scale[3],
                     double out[16])
{
    glm::dmat4 m = glm::mat4_cast(glm::dquat(rotation[3], rotation[0], rotation[1], rotation[2]));
    for (int i = 0; i < 3; i++)
        m[i] *= scale[i];
    m[3] = glm::dvec4(glm::make_vec3(translation), 1.0);
    store(m, out);
}

double ag_mat_determinant3(const double m[16])
{
    return glm::determinant(glm::dmat3(glm::make_mat4(m)));
}

bool ag_mat_finite(const double m[16])
{
    return finite16(m);
}

void ag_mat_point(const double m[16], const double p[3], double out[3])
{
    store(glm::dvec3(glm::make_mat4(m) * glm::dvec4(glm::make_vec3(p), 1.0)), out);
}

void ag_mat_vector(const double m[16], const double v[3], double out[3])
{
    store(glm::dmat3(glm::make_mat4(m)) * glm::make_vec3(v), out);
}

void ag_mat_project(const double m[16], const double p[3], double out[3])
{
    glm::dvec4 clip = glm::make_mat4(m) * glm::dvec4(glm::make_vec3(p), 1.0);
    store(glm::dvec3(clip) / clip.w, out);
}

void ag_mat_normal(const double m[16], double out[9])
{
    const glm::dmat3 a(glm::make_mat4(m));
    // The cofactor matrix is determinant x inverse transpose; its sign is taken back so that
    // a mirrored normal stays on the side that it was on.
    const glm::dmat3 cofactor(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]),
                              glm::cross(a[0], a[1]));
    const double sign = glm::determinant(a) < 0 ? -1.0 : 1.0;
    for (int i = 0; i < 9; i++)
        out[i] = sign * glm::value_ptr(cofactor)[i];
}

void ag_mat_look_to(const double eye[3], const double forward[3], const double up[3],
                    double out[16])
{
    const glm::dvec3 e = glm::make_vec3(eye);
    const glm::dvec3 f = direction(glm::make_vec3(forward), glm::dvec3(0, 0, -1));
    glm::dvec3 u = direction(glm::make_vec3(up), glm::dvec3(0, 1, 0));
    if (glm::length(glm::cross(f, u)) < 1e-6)
        u = perpendicular(f);
    // The rotation alone first: at a far eye, lookAt's difference of nearby points loses digits.
    glm::dmat4 m = glm::lookAtRH(glm::dvec3(0), f, u);
    m[3] = glm::dvec4(glm::dmat3(m) * -e, 1.0);
    store(m, out);
}

void ag_mat_rigid(const double m[16], double out[16])
{
    const glm::dmat4 a = glm::make_mat4(m);
    const glm::dvec3 z = direction(glm::dvec3(a[2]), glm::dvec3(0, 0, 1));
    glm::dvec3 y = direction(glm::dvec3(a[1]), glm::dvec3(0, 1, 0));
    if (glm::length(glm::cross(y, z)) < 1e-6)
        y = perpendicular(z);
    const glm::dvec3 x = glm::normalize(glm::cross(y, z));
    store(glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), a[3]),
          out);
}

void ag_mat_perspective(double yfov, double aspect, double znear, double zfar, double out[16])
{
    if (std::isfinite(zfar)) {
        // Near and far exchanged is what reverses the depth.
        store(glm::perspectiveRH_ZO(yfov, aspect, zfar, znear), out);
        return;
    }
    const double f = 1.0 / std::tan(yfov / 2);
    glm::dmat4 m(0.0);
    m[0][0] = f / aspect;
    m[1][1] = f;
    m[2][3] = -1;
    m[3][2] = znear;
    store(m, out);
}

void ag_mat_orthographic(double half_width, double half_height, double znear, double zfar,
                         double out[16])
{
    store(glm::orthoRH_ZO(-half_width, half_width, -half_height, half_height, zfar, znear), out);
}

void ag_mat_to_float(const double m[16], float out[16])
{
    for (int i = 0; i < 16; i++)
        out[i] = static_cast<float>(m[i]);
}

void ag_mat_from_float(const float m[16], double out[16])
{
    for (int i = 0; i < 16; i++)
        out[i] = static_cast<double>(m[i]);
}

void ag_frame_about(const double n[3], double t[3], double b[3])
{
    const double s = n[2] < 0 ? -1 : 1, a = -1 / (s + n[2]), c = n[0] * n[1] * a;
    const glm::dvec3 first(1 + s * n[0] * n[0] * a, s * c, -s * n[0]);
    const glm::dvec3 second(c, s + n[1] * n[1] * a, -n[1]);
    store(first, t);
    store(second, b);
}

void ag_quat_slerp(const double a[4], const double b[4], double t, double out[4])
{
    const glm::dquat q = glm::normalize(
        glm::slerp(glm::dquat(a[3], a[0], a[1], a[2]), glm::dquat(b[3], b[0], b[1], b[2]), t));
    out[0] = q.x;
    out[1] = q.y;
    out[2] = q.z;
    out[3] = q.w;
}
