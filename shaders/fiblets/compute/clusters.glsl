// The clusters of a chunk, and the fiblets of each: three words a box, least and greatest place along each axis by 16 bits, and behind
// the boxes the fiblets, cluster by cluster. pvfiblets/engine/fiblets/data/clusters.py makes them.

layout(std430, binding = {{ storage_clusters }}) readonly buffer Clusters { uint clusters[]; };

const uint CLUSTER = {{ cluster_size }}u, GROUP_CLUSTERS = {{ group_clusters }}u;

uint cluster_count() { return (chunk_fiblets + CLUSTER - 1u) / CLUSTER; }

// The k-th fiblet in the order of clusters.
uint clustered(uint k) { return clusters[3u * cluster_count() + k]; }
