// Walks with what a network once said: replay HISTORY.f32 SAID.f32 X Z HEADING SEEN.f32 FRAMES.f64
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Motionrt;

internal sealed class Said : IWalkNet
{
    private readonly float[] all;
    private int frame;
    public readonly List<float> Seen = new List<float>();

    public Said(float[] all) { this.all = all; }

    public float[] Next(float[] frames, float speed)
    {
        Seen.AddRange(frames);
        var next = new float[Walker.Width];
        Array.Copy(all, Walker.Width * frame++, next, 0, Walker.Width);
        return next;
    }
}

internal static class Replay
{
    private static float[] Numbers(string file)
    {
        byte[] bytes = File.ReadAllBytes(file);
        var numbers = new float[bytes.Length / 4];
        Buffer.BlockCopy(bytes, 0, numbers, 0, bytes.Length);
        return numbers;
    }

    private static void Main(string[] given)
    {
        float[] said = Numbers(given[1]);
        var network = new Said(said);
        var walker = new Walker(network, Numbers(given[0]));
        Func<int, double> number = i => double.Parse(given[i], CultureInfo.InvariantCulture);
        var goal = new Goal(number(2), number(3), number(4));
        using (var frames = new BinaryWriter(File.Create(given[6])))
            for (int f = 0; f < said.Length / Walker.Width; f++)
                foreach (double value in walker.Step(goal, 1.2f)) frames.Write(value);
        using (var seen = new BinaryWriter(File.Create(given[5])))
            foreach (float value in network.Seen) seen.Write(value);
    }
}
