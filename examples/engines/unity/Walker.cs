// A character walks to a goal: WalkNet at stride 1 (docs/embedding.md), whichever engine computes the network.
// Plain C# 7.2 without any engine's types; UnityWalkNet.cs and OnnxRuntimeWalkNet.cs bring the network.
using System;

namespace Motionrt
{
    /// <summary>The network: 30 frames in the goal's frame, 30 x 219 numbers, and a speed in m/s to the next 219.</summary>
    public interface IWalkNet
    {
        float[] Next(float[] frames, float speed);
    }

    /// <summary>Where to be, in metres, and facing where, in radians from +Z towards +X.</summary>
    public struct Goal
    {
        public double X, Z, Heading;

        public Goal(double x, double z, double heading)
        {
            X = x;
            Z = z;
            Heading = heading;
        }
    }

    /// <summary>A walking character; a frame is 24 rotations row by row, local to their parents, and the pelvis in metres.</summary>
    public sealed class Walker
    {
        public const int History = 30, Joints = 24, Root = 9 * Joints, Width = Root + 3;

        private readonly IWalkNet network;
        private readonly double[][] history;

        /// <param name="network">The network.</param>
        /// <param name="frames">The 30 frames before, 30 x 219 numbers in the world, oldest first.</param>
        public Walker(IWalkNet network, float[] frames)
        {
            if (frames.Length != History * Width)
                throw new ArgumentException("a history is 30 frames of 219 numbers");
            this.network = network;
            history = new double[History][];
            for (int f = 0; f < History; f++)
            {
                history[f] = new double[Width];
                Array.Copy(frames, f * Width, history[f], 0, Width);
            }
        }

        /// <summary>The next frame, 1/30 s later, in the world.</summary>
        public double[] Step(Goal goal, float speed)
        {
            var seen = new float[History * Width];
            for (int f = 0; f < History; f++)
            {
                double[] frame = ToGoal(history[f], goal);
                for (int i = 0; i < Width; i++) seen[f * Width + i] = (float)frame[i];
            }
            float[] found = network.Next(seen, speed);
            var next = new double[Width];
            Array.Copy(found, next, Width);
            for (int joint = 0; joint < Joints; joint++) Orthonormalise(next, 9 * joint);
            next = FromGoal(next, goal);
            Array.Copy(history, 1, history, 0, History - 1);
            history[History - 1] = next;
            return next;
        }

        private static double[] ToGoal(double[] frame, Goal goal)
        {
            var moved = (double[])frame.Clone();
            moved[Root] -= goal.X;
            moved[Root + 2] -= goal.Z;
            Turn(moved, -goal.Heading);
            return moved;
        }

        private static double[] FromGoal(double[] frame, Goal goal)
        {
            var moved = (double[])frame.Clone();
            Turn(moved, goal.Heading);
            moved[Root] += goal.X;
            moved[Root + 2] += goal.Z;
            return moved;
        }

        // Pelvis and place about the vertical axis; heights stay.
        private static void Turn(double[] frame, double yaw)
        {
            double c = Math.Cos(yaw), s = Math.Sin(yaw);
            for (int column = 0; column < 3; column++)
            {
                double first = frame[column], last = frame[6 + column];
                frame[column] = c * first + s * last;
                frame[6 + column] = c * last - s * first;
            }
            double x = frame[Root], z = frame[Root + 2];
            frame[Root] = c * x + s * z;
            frame[Root + 2] = c * z - s * x;
        }

        // The nearest rotation: the polar factor, by Newton's iteration X <- (X + X^-T) / 2.
        private static void Orthonormalise(double[] m, int at)
        {
            var cofactors = new double[9];
            for (int step = 0; step < 30; step++)
            {
                for (int i = 0; i < 3; i++)
                    for (int j = 0; j < 3; j++)
                    {
                        int a = at + 3 * ((i + 1) % 3), b = at + 3 * ((i + 2) % 3), p = (j + 1) % 3, q = (j + 2) % 3;
                        cofactors[3 * i + j] = m[a + p] * m[b + q] - m[a + q] * m[b + p];
                    }
                double determinant = m[at] * cofactors[0] + m[at + 1] * cofactors[1] + m[at + 2] * cofactors[2];
                if (!(determinant > 1e-9))
                    throw new InvalidOperationException("the network predicts no rotation: check the history");
                double change = 0;
                for (int i = 0; i < 9; i++)
                {
                    double next = (m[at + i] + cofactors[i] / determinant) / 2;
                    change = Math.Max(change, Math.Abs(next - m[at + i]));
                    m[at + i] = next;
                }
                if (change < 1e-15) return;
            }
        }
    }
}
