/* Vectors in space. */
#pragma once

#include <math.h>

typedef struct {
    double x, y, z;
} vector3;

static vector3 vector_of(const double *components)
{
    vector3 made;
    made.x = components[0];
    made.y = components[1];
    made.z = components[2];
    return made;
}

static void put_vector(double *components, vector3 v)
{
    components[0] = v.x;
    components[1] = v.y;
    components[2] = v.z;
}

/* p + s q */
static vector3 plus(vector3 p, double s, vector3 q)
{
    p.x += s*q.x;
    p.y += s*q.y;
    p.z += s*q.z;
    return p;
}

static vector3 times(double s, vector3 v)
{
    v.x *= s;
    v.y *= s;
    v.z *= s;
    return v;
}

static double dot(vector3 p, vector3 q)
{
    return p.x*q.x + p.y*q.y + p.z*q.z;
}

static vector3 cross(vector3 p, vector3 q)
{
    vector3 made;
    made.x = p.y*q.z - p.z*q.y;
    made.y = p.z*q.x - p.x*q.z;
    made.z = p.x*q.y - p.y*q.x;
    return made;
}

static double length(vector3 v)
{
    return sqrt(dot(v, v));
}

/* The part of v across a unit vector. */
static vector3 across(vector3 v, vector3 n)
{
    return plus(v, -dot(v, n), n);
}

/* Largest magnitude of a component; NaN if one is NaN. */
static double largest(vector3 v)
{
    double most = fabs(v.x);
    most = fabs(v.y) <= most ? most : fabs(v.y);
    most = fabs(v.z) <= most ? most : fabs(v.z);
    return v.x != v.x || v.y != v.y || v.z != v.z ? (double)NAN : most;
}
