// Only the depth buffer is wanted.

void main() {}
