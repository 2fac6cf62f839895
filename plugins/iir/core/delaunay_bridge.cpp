// SPDX-License-Identifier: MIT
#include "delaunay_bridge.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_on_sphere_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/hilbert_sort.h>

#include <array>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using point2 = kernel::Point_2;
using point3 = kernel::Point_3;

struct delaunay {
    virtual ~delaunay() = default;
    virtual void clear() = 0;
    virtual void insert(int id, const double *point, int near) = 0;
    virtual void sort(const double (*points)[3], std::vector<int> &ids) = 0;
    virtual void remove(int id) = 0;
    virtual int ring(int id, int *out) const = 0;

    std::vector<int> order;
};

namespace
{

// No exception may cross into C.
template <typename F> fg_status guard(F f) noexcept
{
    try {
        f();
        return FG_OK;
    } catch (const std::bad_alloc &) {
        return FG_ERR_MEMORY;
    } catch (...) {
        return FG_ERR_INVALID;
    }
}

point3 point3_of(const double *p)
{
    return point3(p[0], p[1], p[2]);
}

void hilbert_sort3(const double (*points)[3], std::vector<int> &ids)
{
    auto at = [points](int id) { return point3_of(points[id]); };
    auto map = boost::make_function_property_map<int>(at);
    CGAL::hilbert_sort(ids.begin(), ids.end(),
                       CGAL::Spatial_sort_traits_adapter_3<kernel, decltype(map)>(map));
}

// clear() would give the memory back. The caller makes the first vertex again.
template <typename tds, typename range> void erase_all(tds &t, range &simplices)
{
    for (auto i = simplices.begin(); i != simplices.end();)
        simplices.erase(i++);
    for (auto i = t.vertices().begin(); i != t.vertices().end();)
        t.vertices().erase(i++);
    t.set_dimension(-2);
}

// ---- the plane -------------------------------------------------------------------------------

struct plane final : delaunay {
    using vertex_base = CGAL::Triangulation_vertex_base_with_info_2<int, kernel>;
    using tds = CGAL::Triangulation_data_structure_2<vertex_base>;
    using triangulation = CGAL::Delaunay_triangulation_2<kernel, tds>;

    explicit plane(int capacity) : vertices((size_t) capacity)
    {
        t.infinite_vertex()->info() = -1;
    }

    void clear() override
    {
        erase_all(t.tds(), t.tds().faces());
        t.set_infinite_vertex(t.tds().insert_first());
        t.infinite_vertex()->info() = -1;
    }

    void insert(int id, const double *point, int near) override
    {
        const auto count = t.number_of_vertices();
        const auto from = near < 0 ? triangulation::Face_handle() : vertices[(size_t) near]->face();
        const auto v = t.insert(point2(point[0], point[1]), from);
        if (t.number_of_vertices() == count)
            throw std::invalid_argument("two points in one place");
        v->info() = id;
        vertices[(size_t) id] = v;
    }

    void sort(const double (*points)[3], std::vector<int> &ids) override
    {
        auto at = [points](int id) { return point2(points[id][0], points[id][1]); };
        auto map = boost::make_function_property_map<int>(at);
        CGAL::hilbert_sort(ids.begin(), ids.end(),
                           CGAL::Spatial_sort_traits_adapter_2<kernel, decltype(map)>(map));
    }

    void remove(int id) override
    {
        t.remove(vertices[(size_t) id]);
    }

    int ring(int id, int *out) const override
    {
        int size = 0;
        if (t.dimension() < 1)
            return 0;
        const bool line = t.dimension() == 1;
        auto c = t.incident_vertices(vertices[(size_t) id]);
        const auto first = c;
        do {
            if (!line || c->info() >= 0)
                out[size++] = c->info();
            if (line && c->info() >= 0)
                out[size++] = -1;
        } while (++c != first);
        return size;
    }

    triangulation t;
    std::vector<triangulation::Vertex_handle> vertices;
};

// ---- the sphere's surface --------------------------------------------------------------------

// On which side of the plane through a, b, c is d? Never on it: of four points in a plane that
// which comes last in lexicographic order counts as moved along x, or y if that leaves it in the
// plane, or z, and by much more than the others. (Perturbing points along their radius, as CGAL
// does, tells nothing of four on a great circle.)
//
// So four points always span a polytope, and there are no cases of lower dimension.
struct side_of_plane {
    using result_type = CGAL::Orientation;

    result_type operator()(const point3 &a, const point3 &b, const point3 &c, const point3 &d) const
    {
        const CGAL::Orientation side = CGAL::orientation(a, b, c, d);
        return side != CGAL::COPLANAR ? side : perturbed({ &a, &b, &c, &d });
    }

    static CGAL::Orientation perturbed(std::array<const point3 *, 4> p)
    {
        int last = 0;
        for (int i = 1; i < 4; ++i)
            if (CGAL::compare_xyz(*p[(size_t) i], *p[(size_t) last]) == CGAL::LARGER)
                last = i;
        std::swap(p[(size_t) last], p[3]);
        for (int axis = 0; axis < 3; ++axis) { // components of the normal (b - a) x (c - a)
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto flat = [u, v](const point3 *q) { return point2((*q)[u], (*q)[v]); };
            const auto sign = CGAL::orientation(flat(p[0]), flat(p[1]), flat(p[2]));
            if (sign != CGAL::COLLINEAR)
                return last == 3 ? sign : -sign;
        }
        throw std::invalid_argument("three points of the sphere on a line");
    }
};

struct around_origin {
    using result_type = CGAL::Orientation;

    result_type operator()(const point3 &a, const point3 &b, const point3 &c) const
    {
        return CGAL::orientation(point3(CGAL::ORIGIN), a, b, c);
    }
};

struct between_on_great_circle {
    using result_type = bool;

    // Only asked of three points, to orient their circle: any answer serves.
    result_type operator()(const point3 &, const point3 &, const point3 &) const
    {
        return false;
    }
};

// CGAL's own traits, with predicates that are never degenerate and without arcs and circumcentres.
struct sphere_traits : kernel {
    using Point_on_sphere_2 = point3;
    using Arc_on_sphere_2 = kernel::Segment_3;
    using Compare_on_sphere_2 = kernel::Compare_xyz_3;
    using Side_of_oriented_circle_on_sphere_2 = side_of_plane;
    using Orientation_on_sphere_2 = around_origin;
    using Collinear_are_strictly_ordered_on_great_circle_2 = between_on_great_circle;

    Compare_on_sphere_2 compare_on_sphere_2_object() const
    {
        return compare_xyz_3_object();
    }

    side_of_plane side_of_oriented_circle_on_sphere_2_object() const
    {
        return {};
    }

    around_origin orientation_on_sphere_2_object() const
    {
        return {};
    }

    between_on_great_circle collinear_are_strictly_ordered_on_great_circle_2_object() const
    {
        return {};
    }
};

struct sphere final : delaunay {
    using plain_base = CGAL::Triangulation_on_sphere_vertex_base_2<sphere_traits>;
    using vertex_base = CGAL::Triangulation_vertex_base_with_info_2<int, sphere_traits, plain_base>;
    using face_base = CGAL::Triangulation_on_sphere_face_base_2<sphere_traits>;
    using tds = CGAL::Triangulation_data_structure_2<vertex_base, face_base>;
    using triangulation = CGAL::Delaunay_triangulation_on_sphere_2<sphere_traits, tds>;
    using vertex = triangulation::Vertex_handle;
    using face = triangulation::Face_handle;

    explicit sphere(int capacity) : vertices((size_t) capacity)
    {
    }

    void clear() override
    {
        erase_all(t.tds(), t.tds().faces());
    }

    void insert(int id, const double *point, int near) override
    {
        const point3 p = point3_of(point);
        vertex v;
        if (t.dimension() < 2)
            v = t.insert(p, triangulation::OUTSIDE_AFFINE_HULL, face(), 0);
        else
            v = star(p,
                     conflict(p, near < 0 ? vertex(t.vertices_begin()) : vertices[(size_t) near]));
        v->info() = id;
        vertices[(size_t) id] = v;
    }

    // As CGAL's insert(), with lists that stay.
    vertex star(const point3 &p, face visible)
    {
        seen.clear();
        border.clear();
        t.get_conflicts_and_boundary(p, std::back_inserter(seen), std::back_inserter(border),
                                     visible);
        for (face f : seen)
            f->tds_data().clear();
        const vertex v = t.tds().star_hole(border.begin(), border.end());
        v->set_point(p);
        for (face f : seen)
            t.tds().delete_face(f);
        return v;
    }

    // A facet that the point sees from outside. One at the point nearest to it, but for ties.
    face conflict(const point3 &p, vertex v)
    {
        for (vertex next = nearer(p, v); next != v; next = nearer(p, v))
            v = next;
        auto c = t.incident_faces(v);
        const auto first = c;
        do {
            if (t.test_conflict(p, c))
                return c;
        } while (++c != first);
        for (auto f = t.all_faces_begin(); f != t.all_faces_end(); ++f)
            if (t.test_conflict(p, f))
                return f;
        throw std::invalid_argument("a point inside the hull of the others");
    }

    vertex nearer(const point3 &p, vertex v) const
    {
        vertex best = v;
        double least = CGAL::squared_distance(p, v->point());
        auto c = t.incident_vertices(v);
        const auto first = c;
        do {
            const double distance = CGAL::squared_distance(p, c->point());
            if (distance < least) {
                least = distance;
                best = c;
            }
        } while (++c != first);
        return best;
    }

    void sort(const double (*points)[3], std::vector<int> &ids) override
    {
        hilbert_sort3(points, ids);
    }

    // CGAL leaves broken what loses a dimension by a removal: the few that stay are inserted again.
    void remove(int id) override
    {
        if (t.number_of_vertices() > 5) {
            t.remove(vertices[(size_t) id]);
            return;
        }
        std::array<std::pair<int, point3>, 5> rest;
        size_t count = 0;
        for (auto v = t.vertices_begin(); v != t.vertices_end(); ++v)
            if (v->info() != id)
                rest[count++] = { v->info(), v->point() };
        clear();
        for (size_t i = 0; i < count; ++i) {
            const point3 &p = rest[i].second;
            const double at[3] = { p.x(), p.y(), p.z() };
            insert(rest[i].first, at, -1);
        }
    }

    int ring(int id, int *out) const override
    {
        int size = 0;
        if (t.dimension() < 2) { // three points or fewer: in any order
            for (auto v = t.vertices_begin(); v != t.vertices_end(); ++v)
                if (v->info() != id)
                    out[size++] = v->info();
            return size;
        }
        auto c = t.incident_vertices(vertices[(size_t) id]);
        const auto first = c;
        do {
            out[size++] = c->info();
        } while (++c != first);
        return size;
    }

    triangulation t;
    std::vector<vertex> vertices;
    std::vector<face> seen; // facets that a new point sees from outside
    std::vector<triangulation::Edge> border;
};

// ---- tetrahedra ------------------------------------------------------------------------------

struct tetra final : delaunay {
    using vertex_base = CGAL::Triangulation_vertex_base_with_info_3<int, kernel>;
    using cell_base = CGAL::Delaunay_triangulation_cell_base_3<kernel>;
    using tds = CGAL::Triangulation_data_structure_3<vertex_base, cell_base>;
    using triangulation = CGAL::Delaunay_triangulation_3<kernel, tds>;

    explicit tetra(int capacity) : vertices((size_t) capacity)
    {
        t.infinite_vertex()->info() = -1;
    }

    void clear() override
    {
        erase_all(t.tds(), t.tds().cells());
        t.set_infinite_vertex(t.tds().insert_increase_dimension());
        t.infinite_vertex()->info() = -1;
    }

    void insert(int id, const double *point, int near) override
    {
        const auto count = t.number_of_vertices();
        const auto from = near < 0 ? triangulation::Cell_handle() : vertices[(size_t) near]->cell();
        const auto v = t.insert(point3_of(point), from);
        if (t.number_of_vertices() == count)
            throw std::invalid_argument("two points in one place");
        v->info() = id;
        vertices[(size_t) id] = v;
    }

    void sort(const double (*points)[3], std::vector<int> &ids) override
    {
        hilbert_sort3(points, ids);
    }

    void remove(int id) override
    {
        t.remove(vertices[(size_t) id]);
    }

    int ring(int id, int *out) const override
    {
        int size = 0;
        if (t.number_of_vertices() > 3)
            return t.dimension() == 3 ? hull_ring(id, out) : flat_ring(id, out);
        for (auto v = t.finite_vertices_begin(); v != t.finite_vertices_end(); ++v)
            if (v->info() != id)
                out[size++] = v->info();
        return size;
    }

    // Around the edge from the infinite vertex: each cell there is a facet of the hull.
    int hull_ring(int id, int *out) const
    {
        const auto v = vertices[(size_t) id], infinite = t.infinite_vertex();
        triangulation::Cell_handle first;
        int size = 0, i, k;
        if (!t.is_edge(v, infinite, first, i, k)) // looks around the first
            throw std::invalid_argument("a point inside the hull of the others");
        auto c = first;
        do { // leave through the face opposite to one vertex, which the next cell does not have
            i = c->index(infinite);
            k = c->index(v);
            const int left = triangulation::next_around_edge(k, i);
            out[size++] = c->vertex(left)->info();
            c = c->neighbor(left);
        } while (c != first);
        return size;
    }

    // All points in a plane: over the one side of the polygon and back over the other.
    int flat_ring(int id, int *out) const
    {
        const auto v = vertices[(size_t) id];
        auto c = v->cell();
        int size = 0;
        while (c->vertex(tds::ccw(c->index(v))) != t.infinite_vertex())
            c = around(c, v);
        c = around(c, v);
        for (; c->vertex(tds::ccw(c->index(v))) != t.infinite_vertex(); c = around(c, v))
            out[size++] = c->vertex(tds::ccw(c->index(v)))->info();
        for (int i = size - 2; i > 0; --i)
            out[size++] = out[i];
        return size;
    }

    static triangulation::Cell_handle around(triangulation::Cell_handle c,
                                             triangulation::Vertex_handle v)
    {
        return c->neighbor(tds::ccw(c->index(v)));
    }

    triangulation t;
    std::vector<triangulation::Vertex_handle> vertices;
};

} // namespace

delaunay *delaunay_create(delaunay_kind kind, int capacity)
{
    std::unique_ptr<delaunay> t;
    const fg_status status = guard([&] {
        if (kind == DELAUNAY_PLANE)
            t = std::make_unique<plane>(capacity);
        else if (kind == DELAUNAY_SPHERE)
            t = std::make_unique<sphere>(capacity);
        else
            t = std::make_unique<tetra>(capacity);
        t->order.reserve((size_t) capacity);
    });
    return status == FG_OK ? t.release() : nullptr;
}

void delaunay_destroy(delaunay *t)
{
    delete t;
}

fg_status delaunay_clear(delaunay *t)
{
    return guard([&] { t->clear(); });
}

fg_status delaunay_insert(delaunay *t, int id, const double point[3], int near)
{
    return guard([&] { t->insert(id, point, near); });
}

fg_status delaunay_insert_all(delaunay *t, const double (*points)[3], const int *ids, int count)
{
    return guard([&] {
        int near = -1;
        t->order.assign(ids, ids + count);
        t->sort(points, t->order);
        for (int id : t->order) {
            t->insert(id, points[id], near);
            near = id;
        }
    });
}

fg_status delaunay_remove(delaunay *t, int id)
{
    return guard([&] { t->remove(id); });
}

int delaunay_ring(const delaunay *t, int id, int *ring)
{
    int size = -1;
    const fg_status status = guard([&] { size = t->ring(id, ring); });
    return status == FG_OK ? size : -1;
}
