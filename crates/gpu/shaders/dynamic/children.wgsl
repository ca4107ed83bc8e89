// What the nodes of eight children are made of.

const WIDTH = 8u;

// No child.
const NONE = 0xffffffffu;
