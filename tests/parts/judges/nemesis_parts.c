// Reads the pieces of an Exodus mesh with the libraries of that format (SEACAS: Exodus II and Nemesis I),
// joins them by their global numbers, and prints how many elements and nodes there are. Ends with 1 if
// what pieces say of each other differs.
//
//     nemesis_parts PIECES PREFIX       for PREFIX.0, PREFIX.1 and so on
#include <exodusII.h>
#include <ne_nemesisI.h>
#include <stdio.h>
#include <stdlib.h>

static void require(int condition, const char *what) {
  if (condition) return;
  fprintf(stderr, "nemesis_parts: %s\n", what);
  exit(1);
}

// A piece: where its elements and nodes are in the mesh, and what it shares with others.
typedef struct {
  int elements, nodes, maps;
  int *element, *node;       // global numbers, from 1 on
  int *neighbour, *shared;   // per map: the other piece, and how many nodes
  int **common;              // per map: local nodes, from 1 on
} Piece;

static int *numbers(int count) {
  int *list = calloc((size_t)count + 1, sizeof(int));
  require(list != NULL, "no memory");
  return list;
}

static Piece read_piece(const char *name, int pieces, int piece, int whole[2]) {
  Piece p = {0};
  int size = 8, stored = 0;
  float version;
  const int file = ex_open(name, EX_READ, &size, &stored, &version);
  require(file >= 0, "cannot open a piece");
  char title[MAX_LINE_LENGTH + 1], kind[2];
  int dimension, blocks, node_sets, side_sets, all_blocks, all_node_sets, all_side_sets;
  int of_pieces, here;
  require(ex_get_init(file, title, &dimension, &p.nodes, &p.elements, &blocks, &node_sets, &side_sets) >= 0,
          "no sizes");
  require(ne_get_init_info(file, &of_pieces, &here, kind) >= 0 && of_pieces == pieces && here == 1 &&
              kind[0] == 'p', "no piece of a parallel mesh");
  require(ne_get_init_global(file, &whole[0], &whole[1], &all_blocks, &all_node_sets, &all_side_sets) >= 0,
          "no sizes of the whole");
  require(all_blocks == blocks && all_node_sets == node_sets && all_side_sets == side_sets,
          "blocks or sets are not the same in all pieces");
  p.element = numbers(p.elements);
  p.node = numbers(p.nodes);
  require(ex_get_elem_num_map(file, p.element) >= 0 && ex_get_node_num_map(file, p.node) >= 0,
          "no global numbers");

  int inner, border, outer, inner_elements, border_elements, element_maps;
  require(ne_get_loadbal_param(file, &inner, &border, &outer, &inner_elements, &border_elements, &p.maps,
                               &element_maps, piece) >= 0, "no division into inner and border nodes");
  require(inner + border + outer == p.nodes && inner_elements + border_elements == p.elements,
          "inner and border nodes are not all");
  p.neighbour = numbers(p.maps);
  p.shared = numbers(p.maps);
  p.common = calloc((size_t)p.maps + 1, sizeof(int *));
  int *ids = numbers(p.maps), *element_ids = numbers(element_maps), *counts = numbers(element_maps);
  require(p.maps == 0 || ne_get_cmap_params(file, ids, p.shared, element_ids, counts, piece) >= 0,
          "no maps of shared nodes");
  for (int m = 0; m < p.maps; ++m) {
    int *others = numbers(p.shared[m]);
    p.common[m] = numbers(p.shared[m]);
    require(ne_get_node_cmap(file, ids[m], p.common[m], others, piece) >= 0, "no map of shared nodes");
    for (int i = 0; i < p.shared[m]; ++i) require(others[i] == others[0], "a map of several pieces");
    p.neighbour[m] = others[0];
    free(others);
  }
  free(ids);
  free(element_ids);
  free(counts);
  ex_close(file);
  return p;
}

// Both pieces list the same nodes in the same order.
static void compare_shared(const Piece *pieces, int a, int map) {
  const Piece *one = &pieces[a], *other = &pieces[one->neighbour[map]];
  for (int m = 0; m < other->maps; ++m) {
    if (other->neighbour[m] != a) continue;
    require(other->shared[m] == one->shared[map], "neighbours share another number of nodes");
    for (int i = 0; i < one->shared[map]; ++i) {
      require(one->node[one->common[map][i] - 1] == other->node[other->common[m][i] - 1],
              "neighbours share other nodes");
    }
    return;
  }
  require(0, "a neighbour that has no map");
}

int main(int argc, char **argv) {
  require(argc == 3, "needs PIECES PREFIX");
  const int count = atoi(argv[1]);
  int whole[2] = {0, 0};
  Piece *pieces = calloc((size_t)count, sizeof(Piece));
  for (int k = 0; k < count; ++k) {
    char name[4096];
    snprintf(name, sizeof name, "%s.%d", argv[2], k);
    pieces[k] = read_piece(name, count, k, whole);
  }
  int *elements = numbers(whole[1] + 1), *nodes = numbers(whole[0] + 1);
  long total_elements = 0, total_nodes = 0, total_shared = 0;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < pieces[k].elements; ++i) ++elements[pieces[k].element[i]];
    for (int i = 0; i < pieces[k].nodes; ++i) ++nodes[pieces[k].node[i]];
    for (int m = 0; m < pieces[k].maps; ++m) {
      compare_shared(pieces, k, m);
      total_shared += pieces[k].shared[m];
    }
  }
  for (int e = 1; e <= whole[1]; ++e) {
    require(elements[e] == 1, "an element that is not in one piece");
    ++total_elements;
  }
  for (int n = 1; n <= whole[0]; ++n) {
    require(nodes[n] > 0, "a node of no piece");
    ++total_nodes;
    // Each pair of pieces with this node lists it, from both sides.
    total_shared -= (long)nodes[n] * (nodes[n] - 1);
  }
  require(total_shared == 0, "pairs of pieces that do not list a node of both");
  printf("%ld %ld\n", total_elements, total_nodes);
  return 0;
}
