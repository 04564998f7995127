/* Series made one after the other out of series that are known whole, so that what is multiplied stays in registers. */

#define TERM_AT(number, ...) { enum { k = number }; if (k < ORDER) { __VA_ARGS__ } }
/* A statement for each coefficient k but the last, which no rate needs. */
#define EACH_TERM(...) TERM_AT(0, __VA_ARGS__) TERM_AT(1, __VA_ARGS__) TERM_AT(2, __VA_ARGS__) TERM_AT(3, __VA_ARGS__) \
    TERM_AT(4, __VA_ARGS__) TERM_AT(5, __VA_ARGS__) TERM_AT(6, __VA_ARGS__) TERM_AT(7, __VA_ARGS__) \
    TERM_AT(8, __VA_ARGS__) TERM_AT(9, __VA_ARGS__) TERM_AT(10, __VA_ARGS__) TERM_AT(11, __VA_ARGS__) \
    TERM_AT(12, __VA_ARGS__) TERM_AT(13, __VA_ARGS__) TERM_AT(14, __VA_ARGS__) TERM_AT(15, __VA_ARGS__)

enum { TOGETHER = 4 }; /* directions side by side, so that the matrix is loaded once for them */
#define EACH_DIRECTION(d) UNROLL for (int d = 0; d < many; d++)

/* Coefficient k of a times a state's derivative in each direction, its newest coefficient last. */
INLINE void add_products(vec *sum, const vec *a, vec (*const *t)[TERMS], int state, int many, int k)
{
    vec own[TOGETHER];
    EACH_DIRECTION(d) own[d] = a[k]*t[d][state][0];
    UNROLL
    for (int j = k - 1; j >= 0; j--)
        EACH_DIRECTION(d) own[d] += a[j]*t[d][state][k - j];
    EACH_DIRECTION(d) sum[d] += own[d];
}
